#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/report/plot/axis.hpp"
#include "scenarios/report/plot/decimate.hpp"
#include "scenarios/report/plot/plane.hpp"
#include "scenarios/report/plot/svg.hpp"
#include "scenarios/report/plot/time_stack.hpp"

namespace ironbird::scenarios::plot {
namespace {

constexpr double kRoundOff = 1e-12;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct StepCase {
  const char* name;
  double span;
  int most;
  double expected;
};
class NiceStepTest : public ::testing::TestWithParam<StepCase> {};

TEST_P(NiceStepTest, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_NEAR(nice_step(GetParam().span, GetParam().most), GetParam().expected,
              GetParam().expected * kRoundOff);
}

INSTANTIATE_TEST_SUITE_P(Table, NiceStepTest,
                         ::testing::Values(StepCase{"Exact", 10.0, 10, 1.0}, StepCase{"Two", 10.0, 6, 2.0},
                                           StepCase{"Five", 10.0, 3, 5.0}, StepCase{"Ten", 10.0, 1, 10.0},
                                           StepCase{"Small", 0.003, 5, 0.001}, StepCase{"Large", 7e6, 5, 2e6},
                                           StepCase{"Nothing", 0.0, 5, 1.0}),
                         [](const auto& tested) { return tested.param.name; });

TEST(AxisTest, TicksLieInsideAndAreMultiplesOfTheStep) {
  for (const double low : {-3.7, 0.0, 0.013, 1e5}) {
    for (const double span : {1e-3, 0.7, 13.0, 9e4}) {
      const Axis axis = tight_axis({low, low + span, false}, 6);
      ASSERT_FALSE(axis.ticks.empty());
      EXPECT_GE(axis.ticks.size(), 3u);
      EXPECT_LE(axis.ticks.size(), 13u);
      for (const double tick : axis.ticks) {
        EXPECT_GE(tick, axis.low - axis.step * 1e-6);
        EXPECT_LE(tick, axis.high + axis.step * 1e-6);
        EXPECT_NEAR(tick / axis.step, std::round(tick / axis.step), 1e-6);
      }
    }
  }
}

TEST(AxisTest, LabelsHaveTheDecimalsOfTheStepAndNoMinusZero) {
  const Axis fine{0.0, 1.0, 0.05, {}};
  EXPECT_EQ(fine.label(0.15), "0.15");
  EXPECT_EQ(fine.label(-1e-18), "0.00");
  EXPECT_EQ(fine.label(-0.1), "\u22120.10");
  const Axis coarse{0.0, 100.0, 20.0, {}};
  EXPECT_EQ(coarse.label(40.0), "40");
}

TEST(AxisTest, DoesNotMagnifyAQuietCurve) {
  const Axis axis = roomy_axis({2.0, 2.0, false}, 5, 1.0);
  EXPECT_NEAR((axis.low + axis.high) / 2.0, 2.0, kRoundOff);
  EXPECT_GE(axis.high - axis.low, 1.0);
}

TEST(AxisTest, HoldsForARangeWithoutNumbers) {
  Range range;
  range.include({kNone, INFINITY});
  EXPECT_TRUE(range.empty);
  EXPECT_GT(roomy_axis(range, 5, 1.0).high, roomy_axis(range, 5, 1.0).low);
}

TEST(ThinTest, KeepsTheExtremesOfEverySlice) {
  constexpr int kSamples = 24000, kBins = 500;
  std::vector<double> x, y;
  for (int i = 0; i < kSamples; ++i) {
    x.push_back(i * 0.0025);
    y.push_back(std::sin(i * 0.37) * std::cos(i * 0.0113) + (i == 12345 ? 50.0 : i == 777 ? -50.0 : 0.0));
  }
  const double high = x.back();
  const std::vector<Point> thinned = thin(x, y, 0.0, high, kBins);
  EXPECT_LE(thinned.size(), 4u * (kBins + 1));
  EXPECT_EQ(thinned.front(), (Point{x.front(), y.front()}));
  EXPECT_EQ(thinned.back(), (Point{x.back(), y.back()}));
  EXPECT_TRUE(std::is_sorted(thinned.begin(), thinned.end(), [](Point a, Point b) { return a.x < b.x; }));
  for (int bin = 0; bin < kBins; ++bin) {
    const double from = high * bin / kBins, to = high * (bin + 1) / kBins;
    double low_all = INFINITY, high_all = -INFINITY, low_kept = INFINITY, high_kept = -INFINITY;
    for (int i = 0; i < kSamples; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (x[k] < from || x[k] >= to) continue;
      low_all = std::min(low_all, y[k]);
      high_all = std::max(high_all, y[k]);
    }
    for (const Point& p : thinned) {
      if (p.x < from || p.x >= to) continue;
      low_kept = std::min(low_kept, p.y);
      high_kept = std::max(high_kept, p.y);
    }
    EXPECT_EQ(low_kept, low_all) << bin;
    EXPECT_EQ(high_kept, high_all) << bin;
  }
}

TEST(ThinTest, KeepsGapsAndTheNeighboursOfTheRange) {
  const std::vector<Point> out = thin({0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 1.0, kNone, 3.0, 4.0}, 0.5, 3.5, 10);
  ASSERT_EQ(out.size(), 5u);
  EXPECT_TRUE(std::isnan(out[2].y));
  EXPECT_EQ(out.back().x, 4.0);
}

TEST(ThinTest, GivesNothingForNothing) {
  EXPECT_TRUE(thin({}, {}, 0.0, 1.0, 10).empty());
  EXPECT_TRUE(thin({1.0}, {1.0}, 1.0, 1.0, 10).empty());
}

TEST(StraightenTest, NeverMovesTheCurveByMoreThanTheTolerance) {
  constexpr double kTolerance = 0.1;
  std::vector<Point> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back({i * 0.5, 30.0 * std::sin(i * 0.01) + 0.05 * std::sin(i * 1.7)});
  const std::vector<Point> out = straighten(points, kTolerance);
  EXPECT_LT(out.size(), points.size() / 5);
  EXPECT_EQ(out.front(), points.front());
  EXPECT_EQ(out.back(), points.back());
  std::size_t segment = 0;
  for (const Point& p : points) {
    while (segment + 2 < out.size() && out[segment + 1].x < p.x) ++segment;
    const double share = (p.x - out[segment].x) / (out[segment + 1].x - out[segment].x);
    const double y = out[segment].y + share * (out[segment + 1].y - out[segment].y);
    EXPECT_LE(std::abs(y - p.y), kTolerance + kRoundOff) << p.x;
  }
}

TEST(StraightenTest, KeepsAStraightLineByItsEnds) {
  EXPECT_EQ(straighten({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}, {3.0, 3.0}}, 0.01).size(), 2u);
  EXPECT_EQ(straighten({{0.0, 5.0}}, 0.01).size(), 1u);
  EXPECT_TRUE(straighten({}, 0.01).empty());
}

TEST(SvgTest, EscapesWhatXmlReserves) {
  EXPECT_EQ(escaped("a<b & \"c\">\x01"), "a&lt;b &amp; &quot;c&quot;&gt; ");
}

TEST(SvgTest, WritesShortCoordinates) {
  EXPECT_EQ(coordinate(1.04), "1");
  EXPECT_EQ(coordinate(-0.04), "0");
  EXPECT_EQ(coordinate(12.35), "12.4");
}

TEST(SvgTest, LiftsThePenAtGaps) {
  EXPECT_EQ(path_data({{0.0, 1.0}, {1.0, 2.0}, {2.0, kNone}, {3.0, 4.0}}), "M0,1 1,2M3,4");
}

TEST(TimeStackTest, DrawsEachSeriesAndItsTitle) {
  TimeStack stack{"A & B", {}, 600.0, 100.0};
  Panel panel{"north", "m", {{"truth", "c1", {0.0, 1.0}, {0.0, 2.0}}}, {}, 0.5, ""};
  stack.panels = {panel, Panel{"empty", "m", {}, {}, 0.5, "not in the log: /x"}};
  TimeFrame frame;
  frame.range = {0.0, 10.0, false};
  frame.stretches = {{0.0, 10.0, "offboard", "offboard"}};
  frame.marks = {{5.0, "fault: gust", "gust", "fault"}};
  const std::string svg = draw(stack, frame);
  EXPECT_NE(svg.find("<title>A &amp; B</title>"), std::string::npos);
  EXPECT_NE(svg.find("data-name=\"truth\""), std::string::npos);
  EXPECT_NE(svg.find("not in the log: /x"), std::string::npos);
  EXPECT_NE(svg.find("<title>fault: gust</title>"), std::string::npos);
}

/// The data of the first path of this name.
std::string path_named(const std::string& svg, const std::string& name) {
  const std::size_t at = svg.find("data-name=\"" + name + "\" d=\"");
  if (at == std::string::npos) return "no such path";
  const std::size_t from = svg.find(" d=\"", at) + 4;
  return svg.substr(from, svg.find('"', from) - from);
}

TEST(TimeStackTest, DrawsADotForEachValueAndNoLineBetween) {
  TimeStack stack{"dots", {}, 600.0, 100.0};
  stack.panels = {
      Panel{"north", "m", {{"fixes", "c7 dots", {0.0, 5.0, 10.0}, {1.0, kNone, 2.0}}}, {}, 0.5, ""}};
  const std::string dots = path_named(draw(stack, {{0.0, 10.0, false}, {}, {}}), "fixes");
  EXPECT_EQ(std::count(dots.begin(), dots.end(), 'M'), 2) << dots;
  const std::string first = dots.substr(1, dots.find(' ') - 1);
  EXPECT_EQ(dots.substr(0, dots.find('M', 1)), "M" + first + " " + first);
}

TEST(TimeStackTest, DrawsABoundThatIsNearAndDoesNotFlattenTheCurveForOneThatIsFar) {
  const auto drawn = [](double bound) {
    TimeStack stack{"bounds", {}, 600.0, 100.0};
    Panel panel{"north", "m", {{"innovation", "c0", {0.0, 10.0}, {-1.0, 1.0}}}, {}, 0.5, ""};
    panel.bounds = {{"gate", "c0 bound", {0.0, 10.0}, {bound, bound}}};
    stack.panels = {panel};
    return draw(stack, {{0.0, 10.0, false}, {}, {}});
  };
  EXPECT_EQ(path_named(drawn(3.0), "gate").front(), 'M');
  EXPECT_EQ(path_named(drawn(300.0), "gate"), "");
  const std::string alone = path_named(drawn(std::nan("")), "innovation");
  EXPECT_EQ(path_named(drawn(300.0), "innovation"), alone);
  EXPECT_NE(path_named(drawn(3.0), "innovation"), alone) << "the axis takes it in";
}

/// A text of a drawing: where it begins, or its middle or its end is, and how high it stands, px.
struct TextAt {
  double x = 0.0;
  double y = 0.0;
  bool is_end = false;
  std::string words;
};

std::vector<TextAt> texts_of(const std::string& svg, const std::string& name) {
  std::vector<TextAt> found;
  for (std::size_t at = 0; (at = svg.find("<text", at)) != std::string::npos; ++at) {
    const std::string tag = svg.substr(at, svg.find("</text>", at) - at);
    if (tag.find("class=\"" + name) == std::string::npos) continue;
    const auto number = [&](const char* key) { return std::stod(tag.substr(tag.find(key) + 4)); };
    found.push_back({number(" x=\""), number(" y=\""), tag.find(" before\"") != std::string::npos,
                     tag.substr(tag.rfind('>') + 1)});
  }
  return found;
}

constexpr double kWidestLetter = 6.9;  // px, of a face at this size

TimeStack narrow_stack() {
  return {
      "narrow", {Panel{"north", "m", {{"truth", "c1", {0.0, 1.0}, {0.0, 2.0}}}, {}, 0.5, ""}}, 400.0, 60.0};
}

TimeFrame crowded_frame(int marks) {
  TimeFrame frame;
  frame.range = {0.0, 100.0, false};
  for (int i = 0; i < marks; ++i) {
    const std::string name = "waypoint_" + std::to_string(i);
    frame.marks.push_back({100.0 * i / marks, name, name, ""});
  }
  return frame;
}

TEST(TimeStackTest, LeavesRoomBetweenTwoNamesOfARow) {
  constexpr double kRoom = 6.0;  // px that the eye takes for a gap
  std::map<double, std::vector<std::pair<double, double>>> rows;
  for (const TextAt& text : texts_of(draw(narrow_stack(), crowded_frame(200)), "mark-name")) {
    const double width = kWidestLetter * static_cast<double>(text.words.size());
    rows[text.y].emplace_back(text.x - (text.is_end ? width : 0.0), text.x + (text.is_end ? 0.0 : width));
  }
  ASSERT_GT(rows.size(), 1U);
  for (auto& [y, spans] : rows) {
    std::sort(spans.begin(), spans.end());
    ASSERT_GT(spans.size(), 2U);
    for (std::size_t i = 1; i < spans.size(); ++i)
      EXPECT_GT(spans[i].first - spans[i - 1].second, kRoom) << y;
    EXPECT_LE(spans.back().second, 400.0);
  }
}

TEST(TimeStackTest, CountsTheNamesThatHaveNoRoom) {
  const std::string svg = draw(narrow_stack(), crowded_frame(200));
  const std::size_t named = texts_of(svg, "mark-name").size();
  const std::vector<TextAt> more = texts_of(svg, "more");
  ASSERT_EQ(more.size(), 1U);
  EXPECT_EQ(more[0].words, "+" + std::to_string(200 - named) + " more");
  EXPECT_NE(svg.find("<title>no room for: waypoint_"), std::string::npos);
  EXPECT_TRUE(texts_of(draw(narrow_stack(), crowded_frame(4)), "more").empty());
}

TEST(TimeStackTest, PutsTheNameOfAMarkAtTheEndBeforeIt) {
  TimeFrame frame = crowded_frame(0);
  frame.marks = {{99.0, "ground: landed", "landed", ""}};
  const std::vector<TextAt> names = texts_of(draw(narrow_stack(), frame), "mark-name");
  ASSERT_EQ(names.size(), 1U);
  EXPECT_TRUE(names[0].is_end);
}

TEST(TimeStackTest, CountsThePhasesThatHaveNoRoomForTheirNames) {
  TimeFrame frame = crowded_frame(0);
  for (int i = 0; i < 4; ++i) frame.stretches.push_back({19.0 * i, 19.0 * (i + 1), "take_off", "take_off"});
  const std::string svg = draw(narrow_stack(), frame);
  EXPECT_TRUE(texts_of(svg, "phase-name").empty()) << "a stretch of 61 px has no room for eight letters";
  ASSERT_EQ(texts_of(svg, "more").size(), 1U);
  EXPECT_EQ(texts_of(svg, "more")[0].words, "+4 more");
}

TEST(TimeStackTest, GrowsWithTheRowsOfItsNames) {
  const double plain = height(narrow_stack(), crowded_frame(1));
  EXPECT_GT(height(narrow_stack(), crowded_frame(200)), plain + 30.0);
  EXPECT_NE(draw(narrow_stack(), crowded_frame(1)).find("viewBox=\"0 0 400 " + coordinate(plain) + "\""),
            std::string::npos);
}

TEST(PlaneTest, HasTheSameScaleOnBothAxes) {
  Plane plane{"path", "east", "north", "m", {{"t", "c1", {{0.0, 0.0}, {100.0, 10.0}}}}, {}, "", 600.0, 400.0};
  const std::string svg = draw(plane);
  // The only curve runs from the first to the second point: its slope in pixels is that of the plane.
  const std::size_t at = svg.find("d=\"M");
  ASSERT_NE(at, std::string::npos);
  double x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
  ASSERT_EQ(std::sscanf(svg.c_str() + at, "d=\"M%lf,%lf %lf,%lf", &x1, &y1, &x2, &y2), 4);
  constexpr double kPixelRounding = 0.2;  // px: coordinates have one decimal
  EXPECT_NEAR((y1 - y2) * 10.0, x2 - x1, kPixelRounding * 10.0);
}

}  // namespace
}  // namespace ironbird::scenarios::plot
