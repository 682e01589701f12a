#include "scenarios/bench/ground_watch.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ironbird::scenarios {
namespace {

constexpr simulator::Time kTick{2'500'000};

/// Shows the watch `seconds` of contact or flight and collects what it says.
std::vector<std::string> show(GroundWatch& watch, simulator::Truth& truth, bool contact, double seconds) {
  std::vector<std::string> said;
  for (int i = 0; i < static_cast<int>(seconds / 0.0025); ++i) {
    truth.stamp += kTick;
    truth.in_contact = contact;
    if (const auto what = watch.observe(truth)) said.emplace_back(*what);
  }
  return said;
}

TEST(GroundWatchTest, SeesOneFlightFromLiftOffToLanding) {
  GroundWatch watch;
  simulator::Truth truth;
  EXPECT_TRUE(show(watch, truth, true, 2.0).empty());
  EXPECT_EQ(show(watch, truth, false, 2.0), (std::vector<std::string>{"lifted_off"}));
  EXPECT_EQ(show(watch, truth, true, 2.0), (std::vector<std::string>{"landed"}));
}

TEST(GroundWatchTest, SeesALandingUnderAChatteringLandingGear) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, false, 1.0);
  std::vector<std::string> said;
  for (int i = 0; i < 60; ++i) {
    for (const std::string& word : show(watch, truth, i % 2 == 0, 0.02)) said.push_back(word);
  }
  EXPECT_EQ(said, (std::vector<std::string>{"landed"}));
}

TEST(GroundWatchTest, CallsAFallACrash) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, true, 1.0);
  truth.v_NB_N.z() = 6.0;
  show(watch, truth, false, 1.0);
  truth.v_NB_N.z() = 0.0;
  EXPECT_EQ(show(watch, truth, true, 1.0), (std::vector<std::string>{"crashed"}));
  show(watch, truth, false, 1.0);
  EXPECT_EQ(show(watch, truth, true, 1.0), (std::vector<std::string>{"landed"})) << "the next one is its own";
}

TEST(GroundWatchTest, CallsAVehicleOnItsBackCrashed) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, false, 1.0);
  truth.q_NB = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  EXPECT_EQ(show(watch, truth, true, 1.0), (std::vector<std::string>{"crashed"}));
}

TEST(GroundWatchTest, CallsAVehicleThatFallsOverAfterItsLandingCrashed) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, true, 1.0);
  show(watch, truth, false, 1.0);
  EXPECT_EQ(show(watch, truth, true, 1.0), (std::vector<std::string>{"landed"}));
  truth.q_NB = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  EXPECT_TRUE(show(watch, truth, true, 0.9).empty()) << "it may come upright again";
  EXPECT_EQ(show(watch, truth, true, 5.0), (std::vector<std::string>{"crashed"})) << "once";
}

TEST(GroundWatchTest, CallsAVehicleThatFallsOverBeforeItsFlightCrashed) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, true, 1.0);
  truth.q_NB = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  EXPECT_EQ(show(watch, truth, true, 2.0), (std::vector<std::string>{"crashed"}));
}

TEST(GroundWatchTest, TakesAHopForNeitherFlightNorLanding) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, true, 1.0);
  EXPECT_TRUE(show(watch, truth, false, 0.1).empty());
  show(watch, truth, false, 1.0);
  EXPECT_TRUE(show(watch, truth, true, 0.2).empty());
  EXPECT_TRUE(show(watch, truth, false, 0.1).empty());
  EXPECT_EQ(show(watch, truth, true, 1.0), (std::vector<std::string>{"landed"}));
}

}  // namespace
}  // namespace ironbird::scenarios
