// What is compared with what, at which time, in which frame; and what a replay is judged by.

#include "scenarios/replay/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "scenarios/config/config_error.hpp"
#include "scenarios/replay/replay_verdict.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Quaternion;
using autopilot::StateEstimate;
using autopilot::Vector3;
using std::chrono::milliseconds;

double figure(const Comparison& comparison, const std::string& name) {
  for (const Metric& metric : comparison.results()) {
    if (metric.name == name) return metric.value;
  }
  ADD_FAILURE() << "no figure " << name;
  return 0.0;
}

StateEstimate estimate_at(int ms, const Vector3& p_N, double heading = 0.0) {
  StateEstimate estimate;
  estimate.stamp = milliseconds(ms);
  estimate.p_NB_N = p_N;
  estimate.q_NB = Quaternion(Eigen::AngleAxisd(heading, Vector3::UnitZ()));
  estimate.health = autopilot::Health::kGood;
  return estimate;
}

RecordedPosition position_at(int ms, const Vector3& p_N) {
  RecordedPosition position;
  position.stamp = milliseconds(ms);
  position.p_NB_N = p_N;
  return position;
}

constexpr Interval kAll{milliseconds(0), milliseconds(1000)};

TEST(ComparisonTest, TakesOursAtTheRecordedTime) {
  RecordedEstimate recorded;
  recorded.name = "other";
  recorded.positions = {position_at(25, {1.0, 0.0, 5.0}), position_at(75, {3.0, 4.0, 5.0})};
  Comparison comparison(recorded, kAll);
  for (int k = 0; k <= 10; ++k) comparison.observe(estimate_at(10 * k, {0.04 * 10 * k, 0.0, -7.0}));
  EXPECT_NEAR(figure(comparison, "north_difference_rms_m"), 0.0, 1e-12);
  EXPECT_NEAR(figure(comparison, "east_difference_rms_m"), std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(figure(comparison, "horizontal_difference_rms_m"), std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(figure(comparison, "down_difference_rms_m"), 0.0, 1e-12) << "a constant says nothing";
  EXPECT_EQ(figure(comparison, "compared_share"), 1.0);
}

TEST(ComparisonTest, ComparesPositionsOnTheEarth) {
  RecordedEstimate recorded;
  recorded.origin = {true, 0.8, 0.1, 400.0};
  recorded.positions = {position_at(10, {100.0, 0.0, 0.0})};
  Comparison comparison(recorded, kAll);
  for (int k = 0; k < 3; ++k) {
    StateEstimate ours = estimate_at(10 * k, {0.0, 0.0, 0.0});
    ours.origin = {true, 0.8 + 100.0 / 6378145.0, 0.1, 400.0};  // a hundred metres north of theirs
    comparison.observe(ours);
  }
  EXPECT_NEAR(figure(comparison, "north_difference_rms_m"), 0.0, 1e-6);
}

TEST(ComparisonTest, TakesAnglesTheShortWayRound) {
  RecordedEstimate recorded;
  recorded.attitudes.push_back(
      {milliseconds(15), Quaternion(Eigen::AngleAxisd(std::numbers::pi - 0.01, Vector3::UnitZ()))});
  Comparison comparison(recorded, kAll);
  for (int k = 0; k < 3; ++k)
    comparison.observe(estimate_at(10 * k, Vector3::Zero(), -std::numbers::pi + 0.01));
  EXPECT_NEAR(figure(comparison, "heading_difference_rms_deg"), 0.02 * 180.0 / std::numbers::pi, 1e-9);
}

TEST(ComparisonTest, CountsWhatItCouldNotCompare) {
  RecordedEstimate recorded;
  for (int k = 1; k <= 10; ++k) recorded.positions.push_back(position_at(100 * k, Vector3::Zero()));
  Comparison comparison(recorded, kAll);
  for (int k = 0; k <= 100; ++k) {
    StateEstimate ours = estimate_at(10 * k, Vector3::Zero());
    ours.position_known = k <= 50;
    comparison.observe(ours);
  }
  EXPECT_NEAR(figure(comparison, "compared_share"), 0.5, 1e-12) << "heights could be, positions not";
  Comparison cut(recorded, kAll);
  for (int k = 0; k <= 30; ++k) cut.observe(estimate_at(10 * k, Vector3::Zero()));
  EXPECT_NEAR(figure(cut, "compared_share"), 0.3, 1e-12) << "ours ended early";
  EXPECT_TRUE(std::isnan(figure(Comparison(RecordedEstimate{}, kAll), "compared_share")));
}

TEST(ReplayVerdictTest, IsNoPassWhenLittleWasCompared) {
  ReplayResult result;
  result.ready = 1.0;
  result.metrics = {{"compared_share", 0.5, "1", ""}, {"north_difference_rms_m", 0.1, "m", ""}};
  EXPECT_EQ(judge_replay(result, {}, {}).outcome, Outcome::kInconclusive);
  result.metrics[0].value = 0.95;
  EXPECT_EQ(judge_replay(result, {}, {}).outcome, Outcome::kPass);
  EXPECT_EQ(judge_replay(result, {}, {{"north_difference_rms_m", 0.09}}).outcome, Outcome::kFail);
  EXPECT_EQ(judge_replay(result, {}, {{"north_difference_rms_m", 0.11}}).outcome, Outcome::kPass);
  EXPECT_EQ(judge_replay(result, {}, {{"east_difference_rms_m", 0.11}}).outcome, Outcome::kInconclusive);
  result.lost_at_end = true;
  EXPECT_EQ(judge_replay(result, {}, {}).outcome, Outcome::kFail);
}

TEST(ReplayVerdictTest, ReadsBoundsOfFiguresThatThereAre) {
  EXPECT_EQ(parse_replay_bound("roll_difference_rms_deg=0.5").most, 0.5);
  for (const char* text :
       {"roll_difference_rms_deg", "roll_difference_rms_deg=", "roll_difference_rms_deg=x", "roll=1"})
    EXPECT_THROW(parse_replay_bound(text), ConfigError) << text;
}

TEST(ReplayTest, LeavesTakeOffAndLandingOut) {
  RecordedFlight flight;
  flight.end = std::chrono::seconds(80);
  EXPECT_EQ(usual_window(flight).end, flight.end);
  flight.airborne = {{std::chrono::seconds(2), std::chrono::seconds(30)},
                     {std::chrono::seconds(31), std::chrono::seconds(70)}};
  EXPECT_EQ(usual_window(flight).begin, std::chrono::seconds(5));
  EXPECT_EQ(usual_window(flight).end, std::chrono::seconds(69));
}

}  // namespace
}  // namespace ironbird::scenarios
