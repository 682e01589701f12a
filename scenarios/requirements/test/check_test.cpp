#include "scenarios/requirements/check.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "scenarios/requirements/test/check_fixture.hpp"

namespace ironbird::scenarios {
namespace {

double ramp(double t) {
  return t;
}

TEST_F(CheckTest, StaysBelowHasTheMarginOfTheGreatestValue) {
  expect(north("stays_below = '12 m'", ramp), Outcome::kPass, 2.0, 10.0);
  expect(north("stays_below = '950 cm'", ramp), Outcome::kFail, -0.5, 10.0);
}

TEST_F(CheckTest, StaysAboveHasTheMarginOfTheLeastValue) {
  expect(north("stays_above = '-1 m'", ramp), Outcome::kPass, 1.0, 0.0);
  expect(north("stays_above = '1 m'", ramp), Outcome::kFail, -1.0, 0.0);
}

TEST_F(CheckTest, StaysWithinHasTheMarginOfTheNearerEdge) {
  expect(north("stays_within = { low = '-3 m', high = '10.5 m' }", ramp), Outcome::kPass, 0.5, 10.0);
  expect(north("stays_within = { low = '2 m', high = '20 m' }", ramp), Outcome::kFail, -2.0, 0.0);
}

TEST_F(CheckTest, StaysWithinGoesRoundTheCircle) {
  const auto hold = [&](double) { signals_.estimate.heading = -179.0 * kDegree; };
  const CheckResult result = run(
      "signal = 'autopilot.estimate.heading'\nstays_within = { low = '175 deg', high = '185 deg' }", hold);
  expect(result, Outcome::kPass, 4.0 * kDegree, 0.0);
}

TEST_F(CheckTest, ToleratesShortViolationsWhenAsked) {
  // Above 5 m from 3.00 s to 3.99 s.
  const auto bump = [](double t) { return t > 2.995 && t < 3.995 ? 7.0 : 1.0; };
  EXPECT_EQ(north("stays_below = '5 m'", bump).outcome, Outcome::kFail);
  expect(north("stays_below = '5 m'\ntolerated_for = '1 s'", bump), Outcome::kPass, 4.0, 1.0);
  expect(north("stays_below = '5 m'\ntolerated_for = '0.9 s'", bump), Outcome::kFail, -2.0, 3.9);
}

TEST_F(CheckTest, RmsBelowComparesTheRootMeanSquare) {
  const auto square = [](double t) { return std::fmod(t, 2.0) < 0.995 ? 3.0 : -3.0; };
  const CheckResult result = north("rms_below = '3.5 m'", square);
  expect(result, Outcome::kPass, 0.5, 0.0);
  EXPECT_EQ(north("rms_below = '2.5 m'", square).outcome, Outcome::kFail);
}

TEST_F(CheckTest, RmsOfAVectorIsThatOfItsNorm) {
  const auto hold = [&](double) { truth_.p_NB_N = {3.0, 0.0, 4.0}; };
  expect(run("signal = 'truth.p_NB_N'\nrms_below = '6 m'", hold), Outcome::kPass, 1.0, 0.0);
}

TEST_F(CheckTest, RmsOfAnErrorTakesAnglesTheShortWay) {
  const auto hold = [&](double) {
    signals_.estimate.heading = 179.0 * kDegree;
    signals_.trajectory.heading = -179.0 * kDegree;
  };
  const CheckResult result = run(
      "error = ['autopilot.estimate.heading', 'autopilot.trajectory.heading']\nrms_below = '3 deg'", hold);
  expect(result, Outcome::kPass, 1.0 * kDegree, 0.0);
}

TEST_F(CheckTest, FinalBelowLooksAtTheLastSampleOfTheWindow) {
  expect(north("final_below = '11 m'", ramp), Outcome::kPass, 1.0, 10.0);
  expect(north("final_below = '2.5 m'\nuntil = '3 s'", ramp), Outcome::kFail, -0.5, 3.0);
  expect(north("final_below = '2.5 m'\nto = '9 m'", ramp), Outcome::kPass, 1.5, 10.0);
}

TEST_F(CheckTest, SettlesOnceItStaysInTheBand) {
  const auto decay = [](double t) { return 5.0 + 4.0 * std::exp(-t); };
  // |x - 5| <= 0.5 from t = ln 8 = 2.08 s on.
  const CheckResult result = north("to = '5 m'\nsettles = { band = '0.5 m', time = '2.5 s' }", decay);
  expect(result, Outcome::kPass, 0.5 - 4.0 * std::exp(-2.5), 2.5);
  EXPECT_THAT(result.explanation, ::testing::HasSubstr("settled after 2.08 s"));
  expect(north("to = '5 m'\nsettles = { band = '0.5 m', time = '2 s' }", decay), Outcome::kFail,
         0.5 - 4.0 * std::exp(-2.0), 2.0);
}

TEST_F(CheckTest, SettlesCountsFromTheEvent) {
  script_ = {{4.0, "fault", "gust"}};
  const auto gust = [](double t) { return t < 4.0 - kTick / 2.0 ? 100.0 : 4.0 * std::exp(-(t - 4.0)); };
  expect(north("after = 'gust'\nsettles = { band = '0.5 m', time = '2.5 s' }", gust), Outcome::kPass,
         0.5 - 4.0 * std::exp(-2.5), 6.5);
}

TEST_F(CheckTest, SettlesIsOpenWhenTheRunEndsBeforeItsTime) {
  EXPECT_EQ(north("settles = { band = '1 m', time = '20 s' }", ramp).outcome, Outcome::kInconclusive);
}

TEST_F(CheckTest, SettlesLeavingTheBandAgainFails) {
  const auto late = [](double t) { return t > 9.0 ? 2.0 : 0.0; };
  expect(north("settles = { band = '0.5 m', time = '1 s' }", late), Outcome::kFail, -1.5, 9.01);
}

TEST_F(CheckTest, OvershootIsMeasuredPastTheTarget) {
  // From 0 to 5, up to 6 at the top.
  const auto step = [](double t) { return t < 5.0 ? 1.2 * t : 5.0; };
  expect(north("to = '5 m'\novershoot_below = '1.5 m'", step), Outcome::kPass, 0.5 + 1.2 * kTick, 4.99);
  expect(north("to = '5 m'\novershoot_below = '0.5 m'", step), Outcome::kFail, -0.5 + 1.2 * kTick, 4.99);
  // From above, down to -6: the other direction.
  const auto fall = [&](double t) { return -step(t); };
  expect(north("to = '-5 m'\novershoot_below = '1.5 m'", fall), Outcome::kPass, 0.5 + 1.2 * kTick, 4.99);
  const CheckResult none = north("to = '10.5 m'\novershoot_below = '1 m'", ramp);
  expect(none, Outcome::kPass, 1.5, 10.0);
  EXPECT_THAT(none.explanation, ::testing::HasSubstr("never passed"));
}

TEST_F(CheckTest, ARotorsSpeedIsTakenAndToldInRadiansPerSecond) {
  const auto spin = [&](double) {
    truth_.rotor_speed[0] = 400.0;
    truth_.w_NB_B.z() = 0.5;
  };
  const CheckResult rotor = run("signal = 'truth.rotor_speed[0]'\nstays_below = '500 rad/s'", spin);
  EXPECT_EQ(rotor.explanation, "truth.rotor_speed[0] came to 400 rad/s, must stay below 500 rad/s");
  EXPECT_EQ(rotor.angles, Angles::kRadians);
  const CheckResult minutes = run("signal = 'truth.rotor_speed[0]'\nstays_below = '5000 rpm'", spin);
  EXPECT_THAT(minutes.explanation, ::testing::HasSubstr("below 523.6 rad/s"));
  const CheckResult body = run("signal = 'truth.w_NB_B.z'\nstays_below = '1 rad/s'", spin);
  EXPECT_THAT(body.explanation, ::testing::HasSubstr("came to 28.65 deg/s"));
}

TEST_F(CheckTest, ATubeWithoutARouteShowsNothing) {
  EXPECT_EQ(run("signal = 'truth.p_NB_N'\nstays_within_tube = '0.001 m'", [](double) {}).outcome,
            Outcome::kInconclusive);
}

TEST_F(CheckTest, StaysWithinTheTubeAroundThePolyline) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(10, 0, -5)}) {
    autopilot::Waypoint waypoint;
    waypoint.p_N = p;
    signals_.route.waypoints.push_back(waypoint);
  }
  signals_.flight.phase = autopilot::FlightPhase::kOffboard;
  signals_.flight.fcu.armed = true;
  signals_.trajectory.valid = true;
  const auto fly = [&](double t) { truth_.p_NB_N = {t, t > 6.995 ? 0.8 : 0.3, -5.0}; };
  expect(run("signal = 'truth.p_NB_N'\nstays_within_tube = '1 m'", fly), Outcome::kPass, 0.2, 7.0);
  expect(run("signal = 'truth.p_NB_N'\nstays_within_tube = '0.5 m'", fly), Outcome::kFail, -0.3, 7.0);
}

TEST_F(CheckTest, ReachesAValueInTime) {
  expect(north("to = '5 m'\nreaches = { tolerance = '0.1 m', by = '6 s' }", ramp), Outcome::kPass, 0.1, 5.0);
  expect(north("to = '5 m'\nreaches = { tolerance = '0.1 m', by = '4 s' }", ramp), Outcome::kFail, -0.9, 4.0);
}

TEST_F(CheckTest, ReachesAPoint) {
  const auto fly = [&](double t) { truth_.p_NB_N = {t, 0.3, -5.0}; };
  expect(run("signal = 'truth.p_NB_N'\nto_point = [4, 0, -5]\nreaches = { tolerance = '0.5 m' }", fly),
         Outcome::kPass, 0.2, 4.0);
}

TEST_F(CheckTest, HappensWhenAConditionHoldsOnce) {
  const auto phases = [&](double t) {
    signals_.flight.phase =
        t > 3.995 && t < 5.0 ? autopilot::FlightPhase::kOffboard : autopilot::FlightPhase::kHold;
  };
  expect(run("happens = 'autopilot.flight.phase == offboard'", phases), Outcome::kPass, 1.0, 4.0);
  expect(run("never_happens = 'autopilot.flight.phase == offboard'", phases), Outcome::kFail, -1.0, 4.0);
  expect(run("happens = 'autopilot.flight.phase == landing'", phases), Outcome::kFail, -1.0, 0.0);
  expect(run("never_happens = 'autopilot.flight.phase == offboard'\nafter = '6 s'", phases), Outcome::kPass,
         1.0, 6.0);
}

TEST_F(CheckTest, NeverHappensPassesAtTheEdgeOfAStrictComparison) {
  const auto nothing = [](double) {};
  const CheckResult strict = run("never_happens = 'autopilot.flight.fcu.rc_override > 0'", nothing);
  expect(strict, Outcome::kPass, 0.0, 0.0);
  EXPECT_EQ(run("never_happens = 'autopilot.flight.fcu.rc_override >= 0'", nothing).outcome, Outcome::kFail);
}

TEST_F(CheckTest, OrderOfEventsUsesEachEventOnce) {
  const auto nothing = [](double) {};
  script_ = {{1.0, "phase", "take_off"}, {3.0, "phase", "offboard"}};
  const CheckResult twice = run("order_of_events = ['take_off', 'take_off']", nothing);
  EXPECT_EQ(twice.outcome, Outcome::kFail);
  EXPECT_THAT(twice.explanation, testing::HasSubstr("not once more"));
}

TEST_F(CheckTest, IsCalledByWhatItIsAboutWithoutAName) {
  const auto nothing = [](double) {};
  EXPECT_EQ(run("happens = 'truth.in_contact'", nothing).name, "happens truth.in_contact");
  EXPECT_EQ(run("none_of_events = ['crashed', 'landed']", nothing).name, "none_of_events crashed, landed");
  EXPECT_EQ(run("error = ['truth.p_NB_N.x', 'truth.p_NB_N.y']\nrms_below = '1 m'", nothing).name,
            "rms_below truth.p_NB_N.x - truth.p_NB_N.y");
  EXPECT_EQ(run("signal = 'truth.p_NB_N'\nrms_below = '1 m'", nothing).name, "rms_below truth.p_NB_N");
}

TEST_F(CheckTest, RefusesTheErrorOfASignalAgainstItself) {
  EXPECT_THAT(refusal("error = ['truth.p_NB_N', 'truth.p_NB_N']\nrms_below = '1 m'"),
              testing::HasSubstr("both signals are truth.p_NB_N, whose difference is always 0"));
}

TEST_F(CheckTest, NoneOfEventsFailsAtTheFirstOfThem) {
  const auto nothing = [](double) {};
  script_ = {{3.0, "ground", "crashed"}, {5.0, "ground", "landed"}};
  const CheckResult failed = run("none_of_events = ['landed', 'gust', 'ground:crashed']", nothing);
  EXPECT_EQ(failed.outcome, Outcome::kFail);
  EXPECT_NEAR(failed.time, 3.0, kRoundOff);
  EXPECT_EQ(failed.explanation, "landed at 5 s, gust at no time, ground:crashed at 3 s");
  timeline_ = {};
  EXPECT_EQ(run("none_of_events = ['gust', 'refused']", nothing).outcome, Outcome::kPass);
}

TEST_F(CheckTest, NoneOfEventsListensInsideItsWindowOnly) {
  const auto nothing = [](double) {};
  for (const auto& [window, outcome] :
       {std::pair{"after = '4 s'", Outcome::kPass}, std::pair{"until = '2 s'", Outcome::kPass},
        std::pair{"after = '2 s'\nuntil = '4 s'", Outcome::kFail},
        std::pair{"until = 'landing'", Outcome::kInconclusive}}) {
    timeline_ = {};
    script_ = {{3.0, "ground", "crashed"}};
    if (outcome == Outcome::kInconclusive) script_.clear();
    const CheckResult result = run(std::string("none_of_events = ['crashed']\n") + window, nothing);
    EXPECT_EQ(name_of(result.outcome), name_of(outcome)) << window;
  }
}

TEST_F(CheckTest, OrderOfEventsLooksInsideItsWindowOnly) {
  const auto nothing = [](double) {};
  script_ = {{1.0, "phase", "take_off"}, {3.0, "phase", "offboard"}, {5.0, "phase", "landing"}};
  EXPECT_EQ(run("order_of_events = ['offboard']\nafter = '50 s'", nothing).outcome, Outcome::kInconclusive);
  expect(run("order_of_events = ['offboard', 'landing']\nuntil = '4 s'", nothing), Outcome::kFail, -1.0, 5.0);
  EXPECT_EQ(run("order_of_events = ['offboard']\nafter = 'landing'\nuntil = 'offboard'", nothing).outcome,
            Outcome::kInconclusive);
  EXPECT_EQ(run("order_of_events = ['take_off', 'offboard']\nafter = 'take_off'\nuntil = 'offboard'", nothing)
                .outcome,
            Outcome::kPass);
}

TEST_F(CheckTest, AWishIsNotTheDeed) {
  const auto nothing = [](double) {};
  script_ = {{1.0, "request", "take_off"}, {2.0, "request", "detour"}, {3.0, "refused", "swap"}};
  EXPECT_EQ(run("order_of_events = ['take_off']", nothing).outcome, Outcome::kFail);
  EXPECT_EQ(run("order_of_events = ['request:take_off']", nothing).outcome, Outcome::kPass);
  EXPECT_EQ(run("order_of_events = ['detour']", nothing).outcome, Outcome::kPass);
  EXPECT_EQ(run("order_of_events = ['swap']", nothing).outcome, Outcome::kFail);
}

TEST_F(CheckTest, OrderOfEventsNeedsEachAfterTheOneBefore) {
  script_ = {{1.0, "phase", "take_off"}, {3.0, "phase", "offboard"}, {8.0, "phase", "landing"}};
  const auto nothing = [](double) {};
  expect(run("order_of_events = ['take_off', 'offboard', 'landing']", nothing), Outcome::kPass, 2.0, 3.0);
  timeline_ = {};
  expect(run("order_of_events = ['offboard', 'take_off']", nothing), Outcome::kFail, -2.0, 1.0);
  timeline_ = {};
  const CheckResult missing = run("order_of_events = ['offboard', 'hold']", nothing);
  EXPECT_EQ(missing.outcome, Outcome::kFail);
  EXPECT_EQ(missing.explanation, "hold never happened");
}

TEST_F(CheckTest, BoundsMetrics) {
  metrics_ = {{"path_rms_total_m", 0.25, "m", ""}, {"max_tilt_deg", NAN, "deg", ""}};
  const auto nothing = [](double) {};
  const CheckResult below = run("metric = 'path_rms_total_m'\nmetric_below = '30 cm'", nothing);
  EXPECT_EQ(below.outcome, Outcome::kPass);
  EXPECT_NEAR(below.margin, 0.05, kRoundOff);
  EXPECT_EQ(run("metric = 'path_rms_total_m'\nmetric_above = '0.3'", nothing).outcome, Outcome::kFail);
  EXPECT_EQ(run("metric = 'max_tilt_deg'\nmetric_below = '10'", nothing).outcome, Outcome::kInconclusive);
}

TEST_F(CheckTest, WindowsOpenAndCloseAtTimesAndEvents) {
  script_ = {{2.0, "fault", "gust"}, {6.0, "fault_end", "gust"}};
  expect(north("stays_above = '0 m'\nafter = '1.5 s'", ramp), Outcome::kPass, 1.5, 1.5);
  timeline_ = {};
  expect(north("stays_above = '0 m'\nafter = 'gust'", ramp), Outcome::kPass, 2.0, 2.0);
  timeline_ = {};
  expect(north("stays_above = '0 m'\nafter = 'gust + 500 ms'", ramp), Outcome::kPass, 2.5, 2.5);
  timeline_ = {};
  expect(north("stays_below = '10 m'\nuntil = 'fault_end:gust'", ramp), Outcome::kPass, 4.0, 6.0);
}

TEST_F(CheckTest, IsOpenWhenItsEventNeverHappens) {
  const CheckResult result = north("stays_below = '1 m'\nafter = 'landing'", ramp);
  EXPECT_EQ(result.outcome, Outcome::kInconclusive);
  EXPECT_TRUE(std::isnan(result.margin));
  EXPECT_EQ(result.explanation, "landing never happened");
}

TEST_F(CheckTest, IsOpenWhenItsSignalIsNeverThere) {
  const CheckResult result =
      run("signal = 'autopilot.sensors.gnss.altitude'\nstays_below = '1 m'", [](double) {});
  EXPECT_EQ(result.outcome, Outcome::kInconclusive);
}

TEST_F(CheckTest, FailsWhenASignalIsNotANumber) {
  const auto breaks = [](double t) { return t > 4.995 ? std::numeric_limits<double>::quiet_NaN() : 0.0; };
  for (const char* kind : {"stays_below = '1 m'", "rms_below = '1 m'", "final_below = '1 m'"}) {
    const CheckResult result = north(kind, breaks);
    EXPECT_EQ(result.outcome, Outcome::kFail) << kind;
    EXPECT_EQ(result.margin, -std::numeric_limits<double>::infinity());
    EXPECT_NEAR(result.time, 5.0, kRoundOff);
  }
  const auto set = [&](double t) { truth_.p_NB_N.x() = breaks(t); };
  EXPECT_EQ(run("never_happens = 'truth.p_NB_N.x > 1 m'", set).outcome, Outcome::kFail);
}

struct Refusal {
  const char* name;
  const char* toml;
  const char* message;
};
class RefusalTest : public CheckTest, public ::testing::WithParamInterface<Refusal> {};

TEST_P(RefusalTest, NamesWhatDoesNotFit) {
  EXPECT_THAT(refusal(GetParam().toml), ::testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Table, RefusalTest,
    ::testing::Values(
        Refusal{"NoKind", "signal = 'truth.p_NB_N'", "asserts nothing, must have one of rms_below"},
        Refusal{"TwoKinds", "signal = 'truth.p_NB_N'\nrms_below = '1'\nstays_below = '1'",
                "both rms_below and stays_below"},
        Refusal{"UnknownSignal", "signal = 'truth.p'\nrms_below = '1'",
                "signal = \"truth.p\": no signal truth.p"},
        Refusal{"NoSignal", "name = 'x'\nrms_below = '1'", "needs a signal"},
        Refusal{"WrongUnit", "signal = 'truth.p_NB_N'\nrms_below = '1 deg'", "rms_below = \"1 deg\""},
        Refusal{"Negative", "signal = 'truth.p_NB_N'\nrms_below = '-1 m'", "must be >= 0"},
        Refusal{"ErrorOfOne", "error = ['truth.p_NB_N']\nrms_below = '1'",
                "needs a signal, or an error of two signals"},
        Refusal{"Both", "signal = 'truth.p_NB_N'\nerror = ['a', 'b']\nrms_below = '1'",
                "either signal or error"},
        Refusal{"ScalarTube", "signal = 'truth.p_NB_N.x'\nstays_within_tube = '1 m'", "three components"},
        Refusal{"VectorOvershoot", "signal = 'truth.p_NB_N'\novershoot_below = '1 m'", "name a component"},
        Refusal{"PointForNumber", "signal = 'truth.p_NB_N.x'\nto_point = [1, 2, 3]\nfinal_below = '1 m'",
                "to_point is for"},
        Refusal{"NumberForPoint", "signal = 'truth.p_NB_N'\nto = '1 m'\nfinal_below = '1 m'", "use to_point"},
        Refusal{"Band", "signal = 'truth.p_NB_N.x'\nstays_within = { low = '2', high = '1' }", "is above"},
        Refusal{"Window", "signal = 'truth.p_NB_N.x'\nrms_below = '1'\nafter = '5 s'\nuntil = '4 s'",
                "is before after"},
        Refusal{"WindowUnit", "signal = 'truth.p_NB_N.x'\nrms_below = '1'\nafter = '5 m'", "after = \"5 m\""},
        Refusal{"UnknownMetric", "metric = 'speed'\nmetric_below = '1'", "no such metric"},
        Refusal{"SignalForEvents", "signal = 'truth.p_NB_N'\norder_of_events = ['a']", "takes neither"},
        Refusal{"WindowOfAMetric", "metric = 'path_rms_total_m'\nmetric_below = '1 m'\nafter = '5 s'",
                "does not take after"},
        Refusal{"TargetOfABand", "signal = 'truth.p_NB_N.x'\nstays_below = '1 m'\nto = '3 m'",
                "does not take to"},
        Refusal{"ToleratedRms", "signal = 'truth.p_NB_N.x'\nrms_below = '1 m'\ntolerated_for = '3 s'",
                "does not take tolerated_for"},
        Refusal{"MetricOfASignal", "signal = 'truth.p_NB_N.x'\nrms_below = '1 m'\nmetric = 'nonsense'",
                "does not take metric"},
        Refusal{"MetricOfTheMachine", "metric = 'real_time_factor'\nmetric_above = '1'", "no verdict may"},
        Refusal{"NearMetric", "metric = 'path_rms_totl_m'\nmetric_below = '1'", "'path_rms_total_m'"},
        Refusal{"ConditionOfNoValue", "happens = 'autopilot.flight.phase == flying'",
                "happens = \"autopilot.flight.phase == flying\": flying is not a value of"},
        Refusal{"ConditionAboveAll", "never_happens = 'autopilot.estimate.health > lost'",
                "autopilot.estimate.health > lost can never be so; the order is uninitialised < good"},
        Refusal{"ConditionAboveTrue", "never_happens = 'autopilot.estimate.position_known > true'",
                "can never be so; the order is false < true"},
        Refusal{"ConditionOfNoTruth", "never_happens = 'autopilot.estimate.position_known == 2'",
                "2 is not a value of autopilot.estimate.position_known; there are false, true"},
        Refusal{"TruthForAnEnumeration", "happens = 'autopilot.flight.phase == true'",
                "true is not a value of"},
        Refusal{"ConditionBelowAll", "never_happens = 'autopilot.flight.phase < disarmed'", "never be so"},
        Refusal{"NoEvents", "order_of_events = []", "names no event"}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
