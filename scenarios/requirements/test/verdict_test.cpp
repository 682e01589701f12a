#include "scenarios/requirements/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>

#include "scenarios/requirements/judge.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/verdict_json.hpp"
#include "scenarios/requirements/verdict_text.hpp"

namespace ironbird::scenarios {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

CheckResult check(const std::string& name, Outcome outcome, double margin) {
  return {name, "stays_below", outcome, margin, "m", 12.5, "found " + name};
}

Verdict example() {
  Verdict verdict;
  verdict.run = {"three_waypoints", "Three \"waypoints\"", 18446744073709551615ULL, "abc"};
  verdict.checks = {check("a", Outcome::kPass, 0.1), check("long name", Outcome::kFail, -2.0)};
  verdict.checks[1].time = std::numeric_limits<double>::quiet_NaN();
  verdict.metrics = {{"path_rms_total_m", 1.0 / 3.0, "m", "x"}, {"max_tilt_deg", NAN, "deg", "y"}};
  verdict.events = {{2.5, "phase", "take_off"}};
  conclude(verdict, {});
  return verdict;
}

struct OutcomeCase {
  const char* name;
  std::vector<Outcome> checks;
  RunFlaws flaws;
  Outcome expected;
  int exit_code;
};
class ConcludeTest : public ::testing::TestWithParam<OutcomeCase> {};

TEST_P(ConcludeTest, IsTheWorstOfWhatWasFound) {
  Verdict verdict;
  for (const Outcome outcome : GetParam().checks) verdict.checks.push_back(check("c", outcome, 0.0));
  conclude(verdict, GetParam().flaws);
  EXPECT_EQ(name_of(verdict.outcome), name_of(GetParam().expected));
  EXPECT_EQ(exit_code(verdict.outcome), GetParam().exit_code);
  EXPECT_EQ(verdict.reasons.empty(), GetParam().expected == Outcome::kPass);
}

INSTANTIATE_TEST_SUITE_P(
    Table, ConcludeTest,
    ::testing::Values(
        OutcomeCase{"Pass", {Outcome::kPass, Outcome::kPass}, {}, Outcome::kPass, 0},
        OutcomeCase{"Fail", {Outcome::kPass, Outcome::kFail}, {}, Outcome::kFail, 1},
        OutcomeCase{"Open", {Outcome::kPass, Outcome::kInconclusive}, {}, Outcome::kInconclusive, 5},
        OutcomeCase{"FailThenOpen", {Outcome::kFail, Outcome::kInconclusive}, {}, Outcome::kFail, 1},
        OutcomeCase{"OpenThenFail", {Outcome::kInconclusive, Outcome::kFail}, {}, Outcome::kFail, 1},
        OutcomeCase{"NoChecks", {}, {}, Outcome::kInconclusive, 5},
        OutcomeCase{"Gap", {Outcome::kPass}, {{}, {"it never flew"}}, Outcome::kInconclusive, 5},
        OutcomeCase{"FailWithAGap", {Outcome::kFail}, {{}, {"it never flew"}}, Outcome::kFail, 1},
        OutcomeCase{"Invalid", {Outcome::kFail}, {{"the plant diverged"}, {}}, Outcome::kInvalid, 5}),
    [](const auto& tested) { return tested.param.name; });

TEST(VerdictJsonTest, HasItsKeysInTheAgreedOrder) {
  const std::string expected = R"({
  "scenario": "three_waypoints",
  "title": "Three \"waypoints\"",
  "seed": 18446744073709551615,
  "digest": "abc",
  "verdict": "fail",
  "reasons": [
    "long name: found long name"
  ],
  "warnings": [],
  "checks": [
    {
      "name": "a",
      "kind": "stays_below",
      "verdict": "pass",
      "margin": 0.1,
      "unit": "m",
      "time": 12.5,
      "explanation": "found a"
    },
    {
      "name": "long name",
      "kind": "stays_below",
      "verdict": "fail",
      "margin": -2.0,
      "unit": "m",
      "time": null,
      "explanation": "found long name"
    }
  ],
  "metrics": {
    "path_rms_total_m": 0.3333333333333333,
    "max_tilt_deg": null
  },
  "events": [
    {
      "time": 2.5,
      "kind": "phase",
      "text": "take_off"
    }
  ]
}
)";
  EXPECT_EQ(to_json(example()), expected);
}

TEST(VerdictJsonTest, ReadsBackWhatItWrote) {
  const Verdict verdict = verdict_from_json(to_json(example()));
  EXPECT_EQ(to_json(verdict), to_json(example()));
  EXPECT_EQ(verdict.metrics[0].unit, "m");
  EXPECT_TRUE(std::isnan(verdict.checks[1].time));
}

TEST(VerdictJsonTest, TellsAMarginWithoutEndFromNone) {
  Verdict verdict = example();
  verdict.checks[0].margin = -std::numeric_limits<double>::infinity();
  verdict.checks[1].margin = std::numeric_limits<double>::quiet_NaN();
  const Verdict read = verdict_from_json(to_json(verdict));
  EXPECT_EQ(read.checks[0].margin, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(read.checks[1].margin));
}

TEST(VerdictJsonTest, RefusesWhatIsNoVerdict) {
  EXPECT_THROW(verdict_from_json("{}"), std::invalid_argument);
  EXPECT_THROW(verdict_from_json("nonsense"), std::invalid_argument);
  EXPECT_THROW(read_verdict("/nonexistent/verdict.json"), std::runtime_error);
  EXPECT_THROW(write_verdict(example(), "/nonexistent/verdict.json"), std::runtime_error);
}

TEST(VerdictJsonTest, SurvivesTextThatIsNotUtf8) {
  Verdict verdict = example();
  verdict.events[0].text = "\xff";
  EXPECT_NO_THROW(verdict_from_json(to_json(verdict)));
}

TEST(VerdictTableTest, AlignsItsColumns) {
  const std::string expected =
      "three_waypoints: Three \"waypoints\" (seed 18446744073709551615)\n"
      "  verdict       check      margin  at      what was found\n"
      "  pass          a          +0.1 m  12.5 s  found a\n"
      "  fail          long name  -2 m    -       found long name\n"
      "fail: 1 of 2 checks hold\n";
  EXPECT_EQ(verdict_table(example(), false), expected);
}

/// The longest line, in characters.
std::size_t widest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t most = 0;
  for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
  return most;
}

Verdict wordy() {
  Verdict verdict = example();
  verdict.run.seed = 7;
  for (CheckResult& check : verdict.checks) {
    check.explanation = "path_rms_total_m was 0.02152 m, must be below 0.05 m, and all of it is said";
  }
  return verdict;
}

TEST(VerdictTableTest, FitsTheTerminalAndSaysTheSame) {
  for (const std::size_t columns : {40U, 60U, 80U, 120U}) {
    const std::string table = verdict_table(wordy(), false, columns);
    EXPECT_LE(widest(table), columns) << table;
    std::istringstream words(table);
    std::string joined;
    for (std::string word; words >> word;) joined += word + " ";
    EXPECT_THAT(joined, HasSubstr("must be below 0.05 m, and all of it is said")) << table;
    EXPECT_THAT(joined, HasSubstr("+0.1 m")) << table;
  }
}

TEST(VerdictTableTest, ColoursOnlyWhenAsked) {
  EXPECT_THAT(verdict_table(example(), true), HasSubstr("\x1b[1;31mfail"));
  EXPECT_THAT(verdict_table(example(), false), ::testing::Not(HasSubstr("\x1b")));
}

TEST(VerdictLinesTest, SaysOneThingPerLine) {
  EXPECT_EQ(verdict_lines(example()),
            "three_waypoints: pass: a: margin +0.1 m: found a\n"
            "three_waypoints: fail: long name: margin -2 m: found long name\n"
            "three_waypoints: fail\n");
}

TEST(VerdictTest, SaysUnderTheTableWhatNoCheckSays) {
  Verdict verdict = example();
  conclude(verdict, {{}, {"the gust never came", "nor did the rain"}});
  EXPECT_EQ(reasons_of_the_run(verdict_from_json(to_json(verdict))),
            (std::vector<std::string>{"the gust never came", "nor did the rain"}));
  EXPECT_TRUE(verdict_table(verdict, false)
                  .ends_with("fail: 1 of 2 checks hold\n  the gust never came\n  nor did the rain\n"));
  EXPECT_TRUE(
      verdict_lines(verdict).ends_with("three_waypoints: fail: the gust never came; nor did the rain\n"));
}

TEST(VerdictLinesTest, PutsWarningsBehindTheVerdict) {
  Verdict verdict = example();
  verdict.warnings = {"nothing came of it"};
  EXPECT_TRUE(verdict_lines(verdict).ends_with("fail\nthree_waypoints: warning: nothing came of it\n"));
  EXPECT_TRUE(verdict_table(verdict, false).ends_with("\nwarning: nothing came of it\n"));
  EXPECT_EQ(verdict_from_json(to_json(verdict)).warnings, verdict.warnings);
}

TEST(VerdictJsonTest, ReadsAFileFromBeforeThereWereWarnings) {
  std::string text = to_json(example());
  text.erase(text.find("  \"warnings\": [],\n"), std::string("  \"warnings\": [],\n").size());
  EXPECT_TRUE(verdict_from_json(text).warnings.empty());
}

TEST(VerdictJsonTest, KeepsHowTheBenchKeptItsTime) {
  Verdict verdict = example();
  verdict.timing = BenchTiming{
      {{"step", "the autopilot's step", 4, 1e-5, 2e-5, 3e-5, {1e-5, 3e-5}, {1, 3}}}, 400, 7, 3, 11};
  const Verdict read = verdict_from_json(to_json(verdict));
  ASSERT_TRUE(read.timing);
  EXPECT_EQ(read.timing->passes, 400U);
  EXPECT_EQ(read.timing->missed, 7U);
  EXPECT_EQ(read.timing->most_missed, 3U);
  EXPECT_EQ(read.timing->page_faults, 11U);
  ASSERT_EQ(read.timing->stages.size(), 1U);
  EXPECT_EQ(read.timing->stages[0].p99, 2e-5);
  EXPECT_EQ(read.timing->stages[0].counts, (std::vector<std::uint64_t>{1, 3}));
}

TEST(VerdictJsonTest, KeepsWhatWasReplayedAndUnitsOfItsFigures) {
  Verdict verdict;
  EXPECT_EQ(to_json(verdict).find("\"flight\""), std::string::npos) << "a run has no recorded flight";
  verdict.flight = ReplayedFlight{.file = "a.ulg",
                                  .recorder = "PX4 1.14.0 on PX4_FMU_V6C",
                                  .compared_with = "PX4",
                                  .simulated = true,
                                  .magnetometer = 1,
                                  .magnetometer_source = "as named",
                                  .declination = -0.19,
                                  .declination_source = "World Magnetic Model 2020",
                                  .gnss_delay = 0.11,
                                  .gnss_delay_source = "EKF2_GPS_DELAY of the log",
                                  .window_begin = 4.8,
                                  .window_end = 76.1,
                                  .window_source = "the whole log"};
  verdict.metrics = {{"velocity_difference_rms_mps", 0.12, "", ""}};
  const Verdict read = verdict_from_json(to_json(verdict));
  ASSERT_TRUE(read.flight);
  EXPECT_EQ(to_json(read), to_json(verdict));
  EXPECT_EQ(read.flight->magnetometer, 1);
  EXPECT_TRUE(read.flight->simulated);
  EXPECT_EQ(read.flight->declination, -0.19);
  EXPECT_EQ(read.flight->window_end, 76.1);
  EXPECT_EQ(read.metrics.at(0).unit, "m/s");
  verdict.flight->magnetometer.reset();
  EXPECT_FALSE(verdict_from_json(to_json(verdict)).flight->magnetometer);
}

TEST(NumberTextTest, ShowsFourDigitsAndDegrees) {
  EXPECT_EQ(with_unit(0.0431234, "m"), "0.04312 m");
  EXPECT_EQ(with_unit(3.14159265358979 / 4.0, "rad"), "45 deg");
  EXPECT_EQ(with_unit(0.5, "rad/s"), "28.65 deg/s");
  EXPECT_EQ(with_unit(500.0, "rad/s", Angles::kRadians), "500 rad/s") << "of a rotor";
  EXPECT_EQ(with_unit(-0.0, "1"), "0");
  EXPECT_EQ(short_number(123456.7), "123457");
  EXPECT_EQ(short_number(std::numeric_limits<double>::quiet_NaN()), "-");
}

TEST(VerdictJsonTest, KeepsThatARotorCountsInRadians) {
  Verdict verdict = example();
  verdict.checks[0].unit = "rad/s";
  verdict.checks[0].angles = Angles::kRadians;
  EXPECT_EQ(verdict_from_json(to_json(verdict)).checks[0].angles, Angles::kRadians);
  EXPECT_EQ(verdict_from_json(to_json(verdict)).checks[1].angles, Angles::kDegrees);
  EXPECT_NE(verdict_table(verdict, false).find(" rad/s"), std::string::npos);
}

class JudgeTest : public ::testing::Test {
 protected:
  JudgeTest() {
    table_.add("truth", truth_);
    table_.add("autopilot", signals_);
  }
  simulator::Truth truth_;
  autopilot::Signals signals_;
  SignalTable table_;
};

TEST_F(JudgeTest, SeesPhasesArmingAndWaypointsAsEvents) {
  Judge judge({}, table_, {&truth_, &signals_}, 10ms);
  judge.observe(0ms);
  EXPECT_TRUE(judge.events().empty());
  signals_.flight.fcu.armed = true;
  signals_.flight.phase = autopilot::FlightPhase::kTakeOff;
  judge.observe(10ms);
  signals_.trajectory.valid = true;
  signals_.trajectory.reached = 2;
  judge.event(20ms, "fault", "gust");
  judge.observe(20ms);
  signals_.trajectory.finished = true;
  judge.observe(30ms);
  judge.observe(40ms);
  std::string all;
  for (const RunEvent& event : judge.events()) all += event.kind + ":" + event.text + " ";
  EXPECT_EQ(all,
            "arming:armed phase:take_off fault:gust waypoint:waypoint_1 waypoint:waypoint_2 "
            "waypoint:route_finished ");
  EXPECT_EQ(judge.events()[1].time, 0.01);
}

TEST_F(JudgeTest, NamesNoWaypointTwiceWhateverRoutesThereAre) {
  Judge judge({}, table_, {&truth_, &signals_}, 10ms);
  auto time = 0ms;
  for (const std::uint32_t reached : {0U, 1U, 2U, 0U, 0U, 2U, 0U, 1U}) {
    signals_.trajectory.valid = true;
    signals_.trajectory.reached = reached;
    judge.observe(time += 10ms);
  }
  std::string all;
  for (const RunEvent& event : judge.events()) all += event.text + " ";
  EXPECT_EQ(all, "waypoint_1 waypoint_2 waypoint_3 waypoint_4 waypoint_5 ");
}

TEST_F(JudgeTest, SaysWhyThePhaseChangedWhenNobodyAskedForIt) {
  Judge judge({}, table_, {&truth_, &signals_}, 10ms);
  judge.observe(0ms);
  signals_.flight.phase = autopilot::FlightPhase::kLevelDescent;
  signals_.flight.cause = autopilot::PhaseCause::kPositionUnknown;
  judge.observe(10ms);
  ASSERT_EQ(judge.events().size(), 2U);
  EXPECT_EQ(judge.events()[0].kind + ":" + judge.events()[0].text, "cause:position_unknown");
  EXPECT_EQ(judge.events()[1].text, "level_descent");
}

TEST_F(JudgeTest, SaysWhatHappensToThePosition) {
  Judge judge({}, table_, {&truth_, &signals_}, 10ms);
  autopilot::StateEstimate& x = signals_.estimate;
  x.origin.known = true;
  judge.observe(0ms);
  x.position_doubtful = true;
  x.position_offset_N.x() = 300.0;
  judge.observe(10ms);
  x.position_doubtful = false;
  x.position_offset_N.setZero();
  x.position_resets = 1;
  x.position_reset_sum_N.y() = -12.5;
  judge.observe(20ms);
  x.origin.latitude += 100.0 / 6378145.0;
  judge.observe(30ms);
  judge.observe(40ms);
  std::string all;
  for (const RunEvent& event : judge.events()) all += event.kind + ":" + event.text + " ";
  EXPECT_EQ(all,
            "position:doubtful fixes_disagree:300 m position:sure position_reset:12.5 m origin_moved:100 m ");
}

TEST_F(JudgeTest, MakesOneEventOfAHealthThatFlaps) {
  using autopilot::Health;
  Judge judge({}, table_, {&truth_, &signals_}, 10ms);
  signals_.estimate.health = Health::kGood;
  judge.observe(0ms);
  for (int i = 1; i <= 1000; ++i) {
    signals_.estimate.health = i % 3 == 0 ? Health::kDegraded : Health::kGood;
    judge.observe(i * 10ms);
  }
  ASSERT_EQ(judge.events().size(), 2U) << "good, degraded";
  signals_.estimate.health = Health::kGood;
  for (int i = 1001; i <= 1100; ++i) judge.observe(i * 10ms);
  ASSERT_EQ(judge.events().size(), 3U);
  EXPECT_EQ(judge.events()[2].text, "good");
  EXPECT_NEAR(judge.events()[2].time, 10.5, 0.011) << "half a second after the last fault";
  signals_.estimate.health = Health::kLost;
  judge.observe(1101 * 10ms);
  EXPECT_NEAR(judge.events()[3].time, 11.01, 1e-9) << "worse is said at once";
}

TEST_F(JudgeTest, LetsAChecksWindowOpenAtItsOwnEvents) {
  CheckConfig config;
  config.name = "low in offboard";
  config.signal = "truth.p_NB_N.z";
  config.stays_below = "-1 m";
  config.after = "offboard";
  Judge judge({config}, table_, {&truth_, &signals_}, 10ms);
  for (int i = 0; i < 100; ++i) {
    if (i == 50) signals_.flight.phase = autopilot::FlightPhase::kOffboard;
    truth_.p_NB_N.z() = i < 50 ? 0.0 : -3.0;
    judge.observe(i * 10ms);
  }
  const Verdict verdict = judge.finish({"s", "t", 1, "d"}, {}, 0.0);
  EXPECT_EQ(verdict.outcome, Outcome::kPass) << verdict.checks[0].explanation;
  EXPECT_EQ(verdict.checks[0].margin, 2.0);
  EXPECT_EQ(verdict.checks[0].time, 0.5);
}

TEST_F(JudgeTest, NamesTheCheckThatDoesNotFit) {
  CheckConfig config;
  config.name = "broken";
  config.signal = "truth.nothing";
  config.rms_below = "1";
  try {
    const Judge judge({config}, table_, {&truth_, &signals_}, 10ms);
    FAIL() << "it was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("check[0].signal = \"truth.nothing\": no signal truth.nothing"));
  }
}

TEST(TimelineTest, CallsEventsByTextKindOrBoth) {
  Timeline timeline;
  timeline.add(1.0, "fault", "gust");
  timeline.add(2.0, "fault_end", "gust");
  EXPECT_EQ(timeline.first("gust"), 1.0);
  EXPECT_EQ(timeline.first("fault"), 1.0);
  EXPECT_EQ(timeline.first("fault_end:gust"), 2.0);
  EXPECT_EQ(timeline.first("gust", 1.5), 2.0);
  EXPECT_EQ(timeline.first("gus"), std::nullopt);
}

}  // namespace
}  // namespace ironbird::scenarios
