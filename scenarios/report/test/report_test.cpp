#include "scenarios/report/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/report/figures.hpp"
#include "scenarios/report/flight_data.hpp"
#include "scenarios/report/junit.hpp"
#include "scenarios/report/test/synthetic_flight.hpp"

namespace ironbird::scenarios {
namespace {

std::filesystem::path folder(const std::string& name) {
  const testing::TestInfo* test =
      testing::UnitTest::GetInstance()->current_test_info();  // tests run side by side
  return std::filesystem::path(testing::TempDir()) / "ironbird_report_test" / test->name() / name;
}

/// The first mistake in the nesting of tags, or nothing. Knows no empty elements but those closed by "/>".
std::string nesting_mistake(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 2, "<!") == 0 || text.compare(at, 2, "<?") == 0) continue;
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return "tag without end";
    const std::string tag = text.substr(at + 1, end - at - 1);
    const std::size_t name_from = tag[0] == '/' ? 1 : 0;
    const std::string name = tag.substr(name_from, tag.find_first_of(" />", name_from) - name_from);
    if (name_from == 1) {
      if (open.empty() || open.back() != name) return "</" + name + "> closes nothing";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
      if (name == "script" || name == "style") at = text.find("</" + name, end) - 1;
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

TEST(NestingTest, FindsMistakes) {
  EXPECT_EQ(nesting_mistake("<a><b x=\"1\"/></a>"), "");
  EXPECT_NE(nesting_mistake("<a><b></a>"), "");
  EXPECT_NE(nesting_mistake("<a>"), "");
}

Verdict verdict_with(Outcome outcome) {
  Verdict verdict;
  verdict.run.scenario = "a<b";
  CheckResult check;
  check.name = "name \"x\"";
  check.outcome = outcome;
  check.explanation = "1 < 2";
  verdict.checks = {check};
  conclude(verdict, {});
  return verdict;
}

class ReportTest : public ::testing::Test {
 protected:
  static std::vector<ReportRun> one(bool with_truth = true) {
    std::vector<ReportRun> runs;
    runs.push_back(
        SyntheticFlight().fly(folder(with_truth ? "one" : "blind"), "three_waypoints", with_truth));
    return runs;
  }
};

TEST_F(ReportTest, IsWellFormedAndLoadsNothing) {
  const std::string page = report_html(one());
  EXPECT_EQ(nesting_mistake(page), "");
  for (const char* reference : {"http:", "https:", "src=", "@import", "url(http", "<link"}) {
    std::string without_namespace = page;
    const std::string name = "http://www.w3.org/2000/svg";  // a name, not an address that is visited
    for (std::size_t at; (at = without_namespace.find(name)) != std::string::npos;)
      without_namespace.erase(at, name.size());
    EXPECT_EQ(without_namespace.find(reference), std::string::npos) << reference;
  }
  EXPECT_EQ(page.find("nan"), std::string::npos) << page.substr(page.find("nan") - 60, 120);
  write_report(one(), folder("one") / "report.html");
}

TEST_F(ReportTest, SaysTheVerdictFirst) {
  const std::string page = report_html(one());
  const std::size_t stamp = page.find("<div class=\"stamp\">fail</div>");
  ASSERT_NE(stamp, std::string::npos);
  EXPECT_LT(stamp, page.find("<svg"));
  EXPECT_NE(page.find("4 of 5 checks hold, 1 failed."), std::string::npos);
  EXPECT_NE(page.find("&lt;three&gt; &amp; more"), std::string::npos);
}

TEST_F(ReportTest, GivesTheSameBytesForTheSameRuns) {
  EXPECT_EQ(report_html(one()), report_html(one()));
}

TEST_F(ReportTest, StaysSmall) {
  constexpr std::size_t kMostBytes = 1'500'000;  // for 60 s at 200 Hz
  EXPECT_LT(report_html(one()).size(), kMostBytes);
}

TEST_F(ReportTest, SaysWhatIsMissing) {
  const std::string page = report_html(one(/*with_truth=*/false));
  EXPECT_EQ(nesting_mistake(page), "");
  EXPECT_NE(page.find("not in the log: /truth/state"), std::string::npos);
}

TEST_F(ReportTest, OpensALogWithoutAnything) {
  std::filesystem::create_directories(folder("empty"));
  { Recorder recorder(folder("empty") / "flight.mcap"); }
  std::vector<ReportRun> runs;
  runs.emplace_back("empty", Log::read(folder("empty") / "flight.mcap"), std::nullopt);
  const std::string page = report_html(runs);
  EXPECT_EQ(nesting_mistake(page), "");
  EXPECT_NE(page.find("not judged"), std::string::npos);
  EXPECT_NE(page.find("not in the log: /autopilot/estimate /autopilot/trajectory /truth/state"),
            std::string::npos);
}

TEST_F(ReportTest, ReadsNoRunFromALogWithoutMessages) {
  std::filesystem::create_directories(folder("empty"));
  { Recorder recorder(folder("empty") / "flight.mcap"); }
  EXPECT_THROW(ReportRun::read("empty", folder("empty") / "flight.mcap", folder("empty") / "verdict.json"),
               UserError);
}

TEST_F(ReportTest, MissesNothingWhenNoWaypointsWereFlown) {
  std::vector<ReportRun> runs;
  SyntheticFlight flight;
  flight.without_waypoints();
  runs.push_back(flight.fly(folder("no_route"), "no_route"));
  const std::string page = report_html(runs);
  EXPECT_NE(page.find("no leg between two waypoints was flown"), std::string::npos);
  EXPECT_EQ(page.find("not in the log"), std::string::npos);
}

TEST_F(ReportTest, OverlaysSeveralRuns) {
  std::vector<ReportRun> runs = one();
  runs.push_back(SyntheticFlight(0.5).fly(folder("two"), "second & other"));
  const std::string page = report_html(runs);
  EXPECT_EQ(nesting_mistake(page), "");
  EXPECT_NE(page.find("data-name=\"three_waypoints truth\""), std::string::npos);
  EXPECT_NE(page.find("data-name=\"second &amp; other truth\""), std::string::npos);
  write_report(runs, folder("two") / "report.html");
}

TEST_F(ReportTest, SaysWhatADistanceIsOf) {
  std::vector<ReportRun> runs = one();
  Verdict verdict = *runs.front().verdict();
  verdict.events = {{20.0, "position_reset", "4.053 m"}, {30.0, "refused", "take_off: it lies on its back"}};
  runs.front() = {"labels", Log::read(folder("one") / "flight.mcap"), verdict};
  const std::string page = report_html(runs);
  EXPECT_NE(page.find(">position_reset 4.053 m</text>"), std::string::npos);
  EXPECT_NE(page.find(">refused: take_off</text>"), std::string::npos);
}

TEST_F(ReportTest, DrawsWideFiguresOnceMoreForANarrowPage) {
  const std::string page = report_html(one());
  for (const char* title : {"Position and heading against command", "Motors and battery"}) {
    const std::size_t at = page.find(std::string("<figcaption>") + title);
    const std::size_t end = page.find("</figure>", at);
    const std::size_t narrow = page.find("<div class=\"narrow\"><svg class=\"time-stack\"", at);
    EXPECT_LT(page.find("<div class=\"wide\"><svg class=\"time-stack\"", at), narrow) << title;
    EXPECT_LT(narrow, end) << title;
  }
}

// On a wide page what is of class narrow is not shown.
TEST_F(ReportTest, HidesOnlyDrawingsOnAWidePage) {
  const std::string page = report_html(one());
  constexpr std::string_view kHidden = "class=\"narrow";
  int hidden = 0;
  for (std::size_t at = page.find(kHidden); at != std::string::npos; at = page.find(kHidden, at + 1)) {
    ++hidden;
    EXPECT_EQ(page.substr(page.find('>', at) + 1, 4), "<svg") << page.substr(at, 100);
  }
  EXPECT_GT(hidden, 0);
}

TEST_F(ReportTest, WarnsAlthoughTheRunPasses) {
  std::vector<ReportRun> runs = one();
  Verdict verdict = verdict_with(Outcome::kPass);
  verdict.warnings = {"snapshot \"x\" was not taken"};
  runs.front() = {"warned", Log::read(folder("one") / "flight.mcap"), verdict};
  EXPECT_NE(report_html(runs).find("<li>warning: snapshot &quot;x&quot; was not taken</li>"),
            std::string::npos);
}

TEST_F(ReportTest, DrawsNoRunsAtAll) {
  EXPECT_EQ(nesting_mistake(report_html({})), "");
}

TEST_F(ReportTest, ThrowsWhenTheFileCannotBeWritten) {
  EXPECT_THROW(write_report(one(), folder("none") / "no" / "report.html"), std::runtime_error);
}

TEST(FlightDataTest, ThePathIsThatOfTheMissionAndNotOfTheWayHome) {
  const ReportRun run = SyntheticFlight().fly(folder("path"), "path");
  EXPECT_EQ(waypoints_of(run).size(), 3u);
  const Curve distance = path_distance(run, "/autopilot/estimate");
  ASSERT_FALSE(distance.value.empty());
  double squares = 0.0, samples = 0.0;
  for (const double value : distance.value) {
    if (std::isnan(value)) continue;
    squares += value * value;
    samples += 1.0;
  }
  const auto& metrics = run.verdict()->metrics;
  const auto rms = std::find_if(metrics.begin(), metrics.end(),
                                [](const Metric& metric) { return metric.name == "path_rms_total_m"; });
  ASSERT_NE(rms, metrics.end());
  // The curve has four samples for one of the metric's.
  constexpr double kSampling = 0.01;
  EXPECT_NEAR(std::sqrt(squares / samples) / rms->value, 1.0, kSampling);
}

/// The least and the greatest time at which a curve has a number, s.
std::pair<double, double> known(const Curve& curve) {
  std::pair<double, double> span{NAN, NAN};
  for (std::size_t i = 0; i < curve.value.size(); ++i) {
    if (!std::isfinite(curve.value[i])) continue;
    if (std::isnan(span.first)) span.first = curve.time[i];
    span.second = curve.time[i];
  }
  return span;
}

/// The value at the last time not after `time`, s.
double at(const Curve& curve, double time) {
  const auto next = std::upper_bound(curve.time.begin(), curve.time.end(), time);
  return curve.value.at(static_cast<std::size_t>(next - curve.time.begin()) - 1);
}

TEST(FlightDataTest, ACommandIsThereWhileTheCompanionFlies) {
  const ReportRun run = SyntheticFlight().fly(folder("command"), "command");
  constexpr double kPeriod = 0.021;  // s, of what the log holds
  // The trajectory is valid from 2 s to 57 s; offboard are 10 s to 44 s of them.
  for (const Curve& curve :
       {trajectory_of(run, "p_N.x"), command_of(run, "p_N.x", {"p_N.x"}), setpoint_of(run, {"roll"})}) {
    EXPECT_NEAR(known(curve).first, 10.0, kPeriod);
    EXPECT_NEAR(known(curve).second, 44.0, kPeriod);
  }
}

TEST(FlightDataTest, WhileAnOperatorsSetpointFliesTheCommandIsItsOwn) {
  SyntheticFlight flight;
  flight.with_an_operator();
  const ReportRun run = flight.fly(folder("operator"), "operator");
  const Curve north = command_of(run, "p_N.x", {"p_N.x"}), down = command_of(run, "p_N.z", {"p_N.z", "down"});
  const Curve roll = setpoint_of(run, {"roll"}), speed = trajectory_of(run, "v_N.x");
  for (const double time : {15.0, 30.0}) {
    for (const Curve& curve : {north, down, roll, speed}) EXPECT_TRUE(std::isfinite(at(curve, time))) << time;
  }
  for (const Curve& curve : {north, roll, speed}) EXPECT_TRUE(std::isnan(at(curve, 22.0)));
  EXPECT_EQ(at(down, 22.0), -6.0);
  EXPECT_NE(at(down, 30.0), -6.0);
}

TEST(FlightDataTest, AnEstimateIsThereSinceTheEstimatorBegan) {
  const ReportRun run = SyntheticFlight().fly(folder("began"), "began");
  EXPECT_NEAR(known(estimate_of(run, "p_NB_N.x")).first, SyntheticFlight::kEstimatorBegins, 0.01);
  EXPECT_NEAR(known(position_error(run)[0]).first, SyntheticFlight::kEstimatorBegins, 0.01);
}

TEST(FlightDataTest, ErrorsAreEstimateLessTruth) {
  constexpr double kRoundOff = 1e-9;
  const ReportRun run = SyntheticFlight(0.25).fly(folder("errors"), "errors");
  const Curves position = position_error(run);
  ASSERT_EQ(position[1].value.size(), 12001u);
  // East: the offset and a wobble of two centimetres.
  const auto begin = static_cast<std::ptrdiff_t>(SyntheticFlight::kEstimatorBegins / 0.005 + 0.5);
  for (auto error = position[1].value.begin() + begin; error != position[1].value.end(); ++error)
    EXPECT_NEAR(*error, 0.25, 0.02 + kRoundOff);
  const Curves velocity = velocity_error(run), attitude = attitude_error(run);
  for (std::size_t i = static_cast<std::size_t>(begin); i < position[1].value.size(); ++i) {
    EXPECT_NEAR(velocity[0].value[i], 0.0, 0.012 + kRoundOff);
    EXPECT_NEAR(attitude[2].value[i], 0.0, 0.004 + kRoundOff);
  }
}

TEST(FlightDataTest, SaysHowFarApartHeightsBegin) {
  const ReportRun run = SyntheticFlight().fly(folder("heights"), "heights");
  const Curve down = position_error(run)[2];
  ASSERT_TRUE(height_apart(run));
  EXPECT_EQ(*height_apart(run), at(down, known(down).first));
  EXPECT_NE(*height_apart(run), 0.0);
  const ReportRun blind = SyntheticFlight().fly(folder("heights_blind"), "blind", /*with_truth=*/false);
  EXPECT_FALSE(height_apart(blind));
}

TEST(FlightDataTest, ResamplesLinearlyAndHoldsTheEnds) {
  const Curve out = resampled({{0.0, 1.0, 3.0}, {0.0, 2.0, 6.0}}, {-1.0, 0.5, 2.0, 9.0});
  EXPECT_EQ(out.value, (std::vector<double>{0.0, 1.0, 4.0, 6.0}));
  EXPECT_TRUE(resampled({}, {1.0}).empty());
}

TEST(FlightDataTest, ResamplesAnglesTheShortWay) {
  constexpr double kRoundOff = 1e-12;
  const Curve out = resampled_angle({{0.0, 1.0}, {3.1, -3.1}}, {0.5});
  EXPECT_NEAR(std::abs(out.value[0]), 3.141592653589793, kRoundOff);
}

TEST(FlightDataTest, BreaksCurvesWhereAnglesWrap) {
  const Curve out = broken_at_wraps({{0.0, 1.0, 2.0}, {179.0, -179.0, -178.0}});
  ASSERT_EQ(out.value.size(), 4u);
  EXPECT_TRUE(std::isnan(out.value[1]));
}

TEST(JunitTest, MapsOutcomesToCases) {
  const std::string xml = junit_xml({{"a<b", verdict_with(Outcome::kPass), ""},
                                     {"b", verdict_with(Outcome::kFail), ""},
                                     {"c", verdict_with(Outcome::kInconclusive), ""}});
  EXPECT_EQ(nesting_mistake(xml), "");
  EXPECT_NE(xml.find("<testsuite name=\"a&lt;b\" tests=\"1\" failures=\"0\" errors=\"0\" time=\"0\">"),
            std::string::npos);
  EXPECT_NE(xml.find("failures=\"1\" errors=\"0\""), std::string::npos);
  EXPECT_NE(xml.find("failures=\"0\" errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<failure message=\"1 &lt; 2\"/>"), std::string::npos);
  EXPECT_NE(xml.find("<error message=\"1 &lt; 2\"/>"), std::string::npos);
}

TEST(JunitTest, ShowsAnInvalidRunAsACaseOfItsOwn) {
  Verdict verdict = verdict_with(Outcome::kPass);
  conclude(verdict, {{"the plant diverged"}, {}});
  const std::string xml = junit_xml({{"a", verdict, ""}});
  EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("the plant diverged"), std::string::npos);
}

TEST(JunitTest, ShowsWhatTheScenarioSaysAndDidNotHappenAsAnError) {
  Verdict verdict = verdict_with(Outcome::kPass);
  conclude(verdict, {{}, {"event \"gust\" never came"}});
  const std::string xml = junit_xml({{"a", verdict, ""}});
  EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("event &quot;gust&quot; never came"), std::string::npos) << xml;
}

TEST(JunitTest, ShowsARunWithoutAVerdictAsAnError) {
  const std::string xml = junit_xml({{"a", std::nullopt, "mass = \"-1\""}});
  EXPECT_EQ(nesting_mistake(xml), "");
  EXPECT_NE(xml.find("<testsuite name=\"a\" tests=\"1\" failures=\"0\" errors=\"1\" time=\"0\">"),
            std::string::npos);
  EXPECT_NE(
      xml.find(
          "<testcase name=\"the run\" classname=\"a\">\n      <error message=\"mass = &quot;-1&quot;\"/>"),
      std::string::npos)
      << xml;
}

TEST(JunitTest, ShowsWhatFailedAfterAGoodFlight) {
  const std::string xml = junit_xml({{"a", verdict_with(Outcome::kPass), "video.mp4: disk full"}});
  EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("disk full"), std::string::npos);
}

}  // namespace
}  // namespace ironbird::scenarios
