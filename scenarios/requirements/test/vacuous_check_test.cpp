// A check that had nothing to look at, or whose occasion never came, shows nothing and says why.

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/requirements/test/check_fixture.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

/// What a check of this kind would say of a flight.
struct AboutFlight {
  const char* kind;
  std::string what;
  bool has_window = true;
};

const std::string kDown = "signal = 'truth.p_NB_N.z'\n";

const std::vector<AboutFlight>& every_kind() {
  static const std::vector<AboutFlight> kinds = {
      {"rms_below", "signal = 'truth.v_NB_N'\nrms_below = '1 m/s'"},
      {"stays_below", "signal = 'truth.v_NB_N'\nstays_below = '1 m/s'"},
      {"stays_above", kDown + "stays_above = '-5 m'"},
      {"stays_within", kDown + "stays_within = { low = '-5 m', high = '5 m' }"},
      {"final_below", "signal = 'truth.v_NB_N'\nfinal_below = '1 m/s'"},
      {"settles", "signal = 'truth.v_NB_N'\nsettles = { band = '1 m/s', time = '1 s' }"},
      {"overshoot_below", kDown + "to = '-5 m'\novershoot_below = '1 m'"},
      {"stays_within_tube", "signal = 'truth.p_NB_N'\nstays_within_tube = '100 m'"},
      {"reaches", "signal = 'truth.p_NB_N'\nto_point = [0, 0, 0]\nreaches = { tolerance = '1 m' }"},
      {"order_of_events", "order_of_events = ['offboard', 'landing']"},
      {"none_of_events", "none_of_events = ['request:early', 'landing']"},
      {"happens", "happens = 'autopilot.flight.phase == offboard'"},
      {"never_happens", "never_happens = 'autopilot.flight.phase == landing'"},
      {"metric_below", "metric = 'max_tilt_deg'\nmetric_below = '30'", false},
      {"metric_above", "metric = 'max_speed_mps'\nmetric_above = '-1'", false}};
  return kinds;
}

class VacuousCheckTest : public CheckTest {
 protected:
  VacuousCheckTest() {
    autopilot::Waypoint waypoint;
    waypoint.p_N = {0.0, 0.0, -5.0};
    signals_.route.waypoints = {waypoint};
    truth_.in_contact = true;
  }

  /// A run of a vehicle that stands on the ground.
  CheckResult on_ground(const std::string& toml) {
    RunMetrics metrics({&truth_, &signals_}, std::chrono::milliseconds(10));
    for (int i = 0; i < 100; ++i) metrics.observe(i * std::chrono::milliseconds(10));
    metrics_ = metrics.results();
    return run(toml, [](double) {});
  }

  static void expect_nothing_shown(const CheckResult& result, const std::string& of) {
    EXPECT_NE(result.outcome, Outcome::kPass) << of << ": " << result.explanation;
    EXPECT_FALSE(result.explanation.empty()) << of;
  }
};

TEST_F(VacuousCheckTest, KnowsEveryKindThatThereIs) {
  const std::string all = refusal("");
  std::istringstream names(all.substr(all.find("one of ") + 7));
  std::size_t count = 0;
  for (std::string name; std::getline(names >> std::ws, name, ','); ++count) {
    EXPECT_TRUE(std::any_of(every_kind().begin(), every_kind().end(), [&](const AboutFlight& kind) {
      return kind.kind == name;
    })) << name;
  }
  EXPECT_EQ(count, every_kind().size());
}

TEST_F(VacuousCheckTest, PassesNoKindWhoseWindowHeldNoMoment) {
  script_ = {{3.0, "request", "early"}, {6.0, "request", "late"}};
  for (const AboutFlight& kind : every_kind()) {
    if (!kind.has_window) continue;
    for (const char* window : {"after = 'landed'", "after = '20 s'", "after = 'late + 20 s'",
                               "after = 'request:late'\nuntil = 'request:early'"}) {
      timeline_ = {};
      const CheckResult result = run(kind.what + "\n" + window, [](double) {});
      expect_nothing_shown(result, std::string(kind.kind) + ", " + window);
    }
  }
}

TEST_F(VacuousCheckTest, PassesNoKindWhenTheVehicleNeverLeavesTheGround) {
  for (const AboutFlight& kind : every_kind()) {
    // What is true of a vehicle at rest too is claimed of the flight by its window.
    const bool is_settling = std::string_view(kind.kind) == "settles";
    const bool needs_window = (kind.what.find("v_NB_N") != std::string::npos && !is_settling) ||
                              std::string_view(kind.kind).starts_with("stays_") ||
                              std::string_view(kind.kind) == "never_happens" ||
                              std::string_view(kind.kind) == "none_of_events";
    const bool is_tube = std::string_view(kind.kind) == "stays_within_tube";
    const std::string window = needs_window && !is_tube ? "\nafter = 'lifted_off'" : "";
    expect_nothing_shown(on_ground(kind.what + window), kind.kind);
  }
}

struct Occasion {
  const char* name;
  std::string toml;
  const char* reason;
};

class OccasionTest : public VacuousCheckTest, public ::testing::WithParamInterface<Occasion> {};

TEST_P(OccasionTest, ThatNeverCameIsTheReason) {
  script_ = {{6.0, "request", "late"}};
  const CheckResult result = on_ground(GetParam().toml);
  EXPECT_EQ(name_of(result.outcome), "inconclusive") << result.explanation;
  EXPECT_THAT(result.explanation, HasSubstr(GetParam().reason));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OccasionTest,
    ::testing::Values(
        Occasion{"WindowOfAnEvent", kDown + "stays_below = '1 m'\nafter = 'landed'", "landed never happened"},
        Occasion{"WindowBehindTheEnd", kDown + "stays_below = '1 m'\nafter = 'request:late + 20 s'",
                 "the run ended at 10 s, before its window opened at 26 s"},
        Occasion{"WindowTheWrongWayRound",
                 kDown + "stays_below = '1 m'\nafter = 'request:late'\nuntil = '2 s'",
                 "opened at 6 s, after it had closed at 2 s"},
        Occasion{"WindowThatNeverCloses", kDown + "stays_below = '1 m'\nuntil = 'landed'",
                 "shows nothing: landed never happened"},
        Occasion{"WindowThatOutlastsTheRun", kDown + "rms_below = '1 m'\nuntil = 'request:late + 20 s'",
                 "before its window closed at 26 s"},
        Occasion{"TargetFarAway", kDown + "to = '-5 m'\novershoot_below = '1 m'",
                 "shows nothing: it came no nearer than 5 m"},
        Occasion{"TargetUnderfoot", kDown + "to = '0 m'\novershoot_below = '1 m'",
                 "it was there from the start"},
        Occasion{"PlaceUnderfoot",
                 "signal = 'truth.p_NB_N'\nto_point = [0, 0, 0]\nreaches = { tolerance = '1 m' }",
                 "it was there from the start"},
        Occasion{"BandRoundTheStart", "signal = 'truth.v_NB_N'\nsettles = { band = '1 m/s', time = '1 s' }",
                 "it was there from the start"},
        Occasion{"WhatWasSoBefore", "happens = 'truth.in_contact'", "it was so from the start"},
        Occasion{"RouteOnPaper", "signal = 'truth.p_NB_N'\nstays_within_tube = '100 m'",
                 "the route was never flown"},
        Occasion{"TiltOfAVehicleAtRest", "metric = 'max_tilt_deg'\nmetric_below = '30'",
                 "the vehicle never flew"},
        Occasion{"FlightOfNoLength", "metric = 'flight_s'\nmetric_below = '100'", "the vehicle never flew"},
        Occasion{"PathOfNoFlight", "metric = 'path_rms_total_m'\nmetric_below = '1'", "was not measured"},
        Occasion{"SignalThatIsNotThere", "signal = 'autopilot.sensors.gnss.altitude'\nstays_below = '1 m'",
                 "was never there to be judged"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(VacuousCheckTest, LeavesAFailureAFailure) {
  EXPECT_EQ(on_ground(kDown + "stays_below = '-1 m'\nuntil = 'landed'").outcome, Outcome::kFail);
  EXPECT_EQ(on_ground("metric = 'max_speed_mps'\nmetric_above = '1'").outcome, Outcome::kFail);
}

TEST_F(VacuousCheckTest, TakesOneMomentForEnoughWhereOneIs) {
  script_ = {{6.0, "request", "late"}};
  EXPECT_EQ(on_ground("happens = 'truth.in_contact'\nafter = '0 s'\nuntil = 'landed'").outcome,
            Outcome::kPass);
  EXPECT_EQ(on_ground("order_of_events = ['request:late']\nuntil = 'landed'").outcome, Outcome::kPass);
  EXPECT_EQ(on_ground("metric = 'simulated_s'\nmetric_below = '100'").outcome, Outcome::kPass);
}

TEST_F(VacuousCheckTest, AToleranceLongerThanItsWindowForgivesNothing) {
  const auto leave = [](double t) { return t > 9.0 ? 7.0 : 1.0; };
  EXPECT_EQ(north("stays_below = '5 m'\nafter = '8.5 s'\ntolerated_for = '3 s'", leave).outcome,
            Outcome::kInconclusive);
  EXPECT_EQ(north("stays_below = '8 m'\nafter = '8.5 s'\ntolerated_for = '3 s'", leave).outcome,
            Outcome::kPass);
}

}  // namespace
}  // namespace ironbird::scenarios
