#include "scenarios/bench/ground_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace ironbird::scenarios {
namespace {

constexpr simulator::Time kTick{2'500'000};

/// Shows the watch `duration` seconds of contact or flight and collects what it says.
std::vector<std::string> show(GroundWatch& watch, simulator::Truth& truth, bool contact, double duration) {
  std::vector<std::string> said;
  for (int i = 0; i < static_cast<int>(duration / 0.0025); ++i) {
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

/// A stretch of a recorded touch-down: how long the vehicle was off the ground or on it, and how fast it sank
/// at the end of that.
struct Stretch {
  bool contact;
  double seconds;
  double sink;  // m/s
};

struct TouchDown {
  const char* name;
  std::vector<Stretch> shape;
  std::vector<std::string> told;
  double first_word_at;  // s, since the vehicle was first seen in the air; that is told after 0.3 s
};

class TouchDownTest : public ::testing::TestWithParam<TouchDown> {};

TEST_P(TouchDownTest, IsToldForWhatItWasAndWhenItWas) {
  GroundWatch watch;
  simulator::Truth truth;
  show(watch, truth, false, 1.0);
  const simulator::Time start = truth.stamp;
  std::vector<std::string> told;
  double first_word_at = 0.0;
  for (const Stretch& stretch : GetParam().shape) {
    truth.v_NB_N.z() = stretch.sink;
    for (int i = 0; i < static_cast<int>(stretch.seconds / 0.0025 + 0.5); ++i) {
      for (const std::string& word : show(watch, truth, stretch.contact, 0.0025)) {
        told.push_back(word);
        if (told.size() == 1) first_word_at = std::chrono::duration<double>(truth.stamp - start).count();
      }
    }
  }
  EXPECT_EQ(told, GetParam().told);
  EXPECT_NEAR(first_word_at, GetParam().first_word_at, 0.003);
}

// As the X650 came down: what was seen of truth.in_contact and truth.v_NB_N.z, tick by tick, in short.
INSTANTIATE_TEST_SUITE_P(
    Recorded, TouchDownTest,
    ::testing::Values(
        // The FCU's failsafe from 30 m: it strikes, is carried up again for two seconds, and sits down
        // softly.
        TouchDown{"RadioLost",
                  {{false, 5.0, 3.85},
                   {true, 0.0775, -0.47},
                   {false, 2.17, 0.389},
                   {true, 0.085, -0.038},
                   {false, 0.46, 0.0342},
                   {true, 0.1, -0.003},
                   {false, 0.045, 0.0035},
                   {true, 0.215, 0.0002},
                   {false, 0.0025, 0.0006},
                   {true, 0.0275, -0.0002},
                   {false, 0.0025, 0.0001},
                   {true, 0.5, 0.0}},
                  {"crashed", "lifted_off", "landed"},
                  5.0},
        // An empty battery: it strikes, hops and lies still.
        TouchDown{"EmptyBattery",
                  {{false, 2.0, 4.39}, {true, 0.085, -0.42}, {false, 0.265, 0.411}, {true, 5.0, 0.0}},
                  {"crashed"},
                  2.0},
        // Motors stopped in the air.
        TouchDown{"Dropped", {{false, 2.0, 5.58}, {true, 6.0, 0.0}}, {"crashed"}, 2.0},
        // A rotor lost: it strikes and tumbles with its motors running.
        TouchDown{"RotorLost",
                  {{false, 3.0, 8.52},
                   {true, 0.0775, -0.632},
                   {false, 0.1525, 0.385},
                   {true, 0.05, -0.05},
                   {false, 0.07, 0.597},
                   {true, 0.015, 0.433},
                   {false, 0.0475, 0.821},
                   {true, 3.0, 0.0}},
                  {"crashed"},
                  3.0},
        // A landing as it should be.
        TouchDown{"Landed",
                  {{false, 2.0, 0.4}, {true, 0.1, 0.0}, {false, 0.02, 0.01}, {true, 2.0, 0.0}},
                  {"landed"},
                  2.5}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace ironbird::scenarios
