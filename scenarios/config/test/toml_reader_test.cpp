#include "scenarios/config/toml_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "autopilot/types/mission.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Matrix3;
using autopilot::Quaternion;
using autopilot::Route;
using autopilot::Time;
using autopilot::Vector2;
using autopilot::Vector3;
using autopilot::WaypointKind;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::ElementsAre;

struct Gains {
  double pull = 0.5;
  int order = 2;
  std::optional<double> limit;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pull", self.pull, "1/s", "how hard", 0.0, 20.0);
    visit("order", self.order, "1", "of the filter", 1.0, 4.0);
    visit("limit", self.limit, "m/s", "of the speed", 0.0);
  }
};

struct Config {
  std::string title = "none";
  bool fast = false;
  Time period = milliseconds(5);
  float level = 1.0f;
  std::uint8_t count = 3;
  std::uint64_t seed = 1;
  Vector2 plane = Vector2::Zero();
  Vector3 turn = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Matrix3 inertia = Matrix3::Identity();
  std::array<double, 4> mix{1.0, 1.0, 1.0, 1.0};
  std::vector<std::string> names;
  std::vector<WaypointKind> kinds;
  double anything = 0.0;
  Gains gains;
  std::optional<Gains> spare;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("title", self.title, "", "what it is called");
    visit("fast", self.fast, "1", "hurry");
    visit("period", self.period, "ns", "between two steps", 1e3, 1e9);
    visit("level", self.level, "V", "of the signal", -10.0, 10.0);
    visit("count", self.count, "1", "how many");
    visit("seed", self.seed, "1", "of chance");
    visit("plane", self.plane, "m", "in the plane");
    visit("turn", self.turn, "rad/s", "rates", -10.0, 10.0);
    visit("q_NB", self.q_NB, "1", "attitude");
    visit("inertia", self.inertia, "kg*m^2", "about the centre of mass");
    visit("mix", self.mix, "1", "shares", 0.0, 1.0);
    visit("names", self.names, "", "of things");
    visit("kinds", self.kinds, "1", "of waypoints");
    visit("anything", self.anything, "", "in whatever unit");
    visit("gains", self.gains, "", "in use");
    visit("spare", self.spare, "", "for later");
  }
};

Config read(std::string_view text) {
  Config config;
  read_toml(parse_toml(text, "x.toml"), config);
  return config;
}

TEST(TomlReaderTest, KeepsDefaultsForMissingKeys) {
  const Config config = read("");
  EXPECT_EQ(config.title, "none");
  EXPECT_EQ(config.period, milliseconds(5));
  EXPECT_FALSE(config.spare.has_value());
}

TEST(TomlReaderTest, FillsEveryKindOfMember) {
  const Config config = read(R"(
title = "Nine \"lives\""
fast = true
period = "400 Hz"
level = "250 mV"
count = 255
seed = 9007199254740993
plane = [1, "20 cm"]
turn = ["90 deg/s", 0, -1.5]
q_NB = [0.5, -0.5, 0.5, 0.5]
inertia = [[1, 2, 3], [4, 5, 6], [7, 8, "90000 g*cm^2"]]
mix = [0.25, "50 %"]
names = ["a", "b"]
kinds = ["land", "goto"]
anything = "36 km/h"
[gains]
pull = 2
[spare]
order = 4
limit = "72 km/h"
)");
  EXPECT_EQ(config.title, "Nine \"lives\"");
  EXPECT_TRUE(config.fast);
  EXPECT_EQ(config.period, microseconds(2500));
  EXPECT_EQ(config.level, 0.25f);
  EXPECT_EQ(config.count, 255);
  EXPECT_EQ(config.seed, 9007199254740993u);
  EXPECT_EQ(config.plane, Vector2(1.0, 0.2));
  EXPECT_EQ(config.turn, Vector3(90.0 * 3.14159265358979323846 / 180.0, 0.0, -1.5));
  EXPECT_EQ(config.q_NB.w(), 0.5);
  EXPECT_EQ(config.q_NB.x(), -0.5);
  EXPECT_EQ(config.inertia(0, 2), 3.0);
  EXPECT_DOUBLE_EQ(config.inertia(2, 2), 0.009);
  EXPECT_THAT(config.mix, ElementsAre(0.25, 0.5, 1.0, 1.0));
  EXPECT_THAT(config.names, ElementsAre("a", "b"));
  EXPECT_THAT(config.kinds, ElementsAre(WaypointKind::kLand, WaypointKind::kGoto));
  EXPECT_DOUBLE_EQ(config.anything, 10.0);
  EXPECT_EQ(config.gains.pull, 2.0);
  EXPECT_EQ(config.gains.order, 2);
  EXPECT_EQ(config.spare->order, 4);
  EXPECT_DOUBLE_EQ(config.spare->limit.value(), 20.0);
}

TEST(TomlReaderTest, ReadsABareTimeAsSeconds) {
  EXPECT_EQ(read("period = 0.5").period, milliseconds(500));
}

struct FindingCase {
  const char* text;
  const char* finding;
};
class FindingTest : public ::testing::TestWithParam<FindingCase> {};

TEST_P(FindingTest, SaysPlaceValueAndWhatIsAllowed) {
  try {
    read(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), GetParam().finding);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Findings, FindingTest,
    ::testing::Values(
        FindingCase{"\n  tilte = 'x'", "x.toml:2:3: tilte = 'x': unknown key, did you mean 'title'?"},
        FindingCase{"[gains]\nwobble = 1",
                    "x.toml:2:1: gains.wobble = 1: unknown key, known are: pull, order, limit"},
        FindingCase{"title = 5", "x.toml:1:9: title = 5: must be a text in quotes"},
        FindingCase{"fast = 1", "x.toml:1:8: fast = 1: must be true or false"},
        FindingCase{"level = true", "x.toml:1:9: level = true: must be a number, in V"},
        FindingCase{"level = nan", "x.toml:1:9: level = nan: must be finite"},
        FindingCase{"level = -inf", "x.toml:1:9: level = -inf: must be finite"},
        FindingCase{"level = 11", "x.toml:1:9: level = 11: must be between -10 and 10 V"},
        FindingCase{"level = '5 A'", "x.toml:1:9: level = '5 A': found 'A', needs V or mV"},
        FindingCase{"count = 256", "x.toml:1:9: count = 256: must be between 0 and 255"},
        FindingCase{"count = 1.5", "x.toml:1:9: count = 1.5: must be a whole number"},
        FindingCase{"count = '3'", "x.toml:1:9: count = '3': must be a whole number"},
        FindingCase{"period = '2 s'", "x.toml:1:10: period = '2 s': must be between 1e-06 and 1 s"},
        FindingCase{"period = '5 m'",
                    "x.toml:1:10: period = '5 m': found 'm', needs s, ms, us, min, h or Hz (its rate)"},
        FindingCase{"level = -11.3", "x.toml:1:9: level = -11.3: must be between -10 and 10 V"},
        FindingCase{"level = 3e20", "x.toml:1:9: level = 3e+20: must be between -10 and 10 V"},
        FindingCase{"level = -12.0", "x.toml:1:9: level = -12.0: must be between -10 and 10 V"},
        FindingCase{"plane = [0.1, -3.9, 2.0]",
                    "x.toml:1:9: plane = [ 0.1, -3.9, 2.0 ]: must have 2 elements, has 3"},
        FindingCase{"title = { a = 0.3, b = [], c = 'x' }",
                    "x.toml:1:9: title = { a = 0.3, b = [], c = 'x' }: must be a text in quotes"},
        FindingCase{"pull = 2", "x.toml:1:1: pull = 2: unknown key, did you mean 'gains.pull'?"},
        FindingCase{"limt = 2", "x.toml:1:1: limt = 2: unknown key, did you mean 'gains.limit'?"},
        FindingCase{"plane = [1]", "x.toml:1:9: plane = [ 1 ]: must have 2 elements, has 1"},
        FindingCase{"plane = 1", "x.toml:1:9: plane = 1: must be an array"},
        FindingCase{"turn = [0, 0, '700 deg/s']",
                    "x.toml:1:15: turn[2] = '700 deg/s': must be between -10 and 10 rad/s"},
        FindingCase{"q_NB = [1, 1, 0, 0]",
                    "x.toml:1:8: q_NB = [ 1, 1, 0, 0 ]: must be [w, x, y, z] of length 1"},
        FindingCase{"inertia = [[1, 2, 3], [4, 5], [6, 7, 8]]",
                    "x.toml:1:23: inertia[1] = [ 4, 5 ]: must have 3 elements, has 2"},
        FindingCase{"mix = [1, 1, 1, 1, 1]",
                    "x.toml:1:7: mix = [ 1, 1, 1, 1, 1 ]: must have at most 4 elements, has 5"},
        FindingCase{"mix = [2]", "x.toml:1:8: mix[0] = 2: must be between 0 and 1"},
        FindingCase{"kinds = ['hodl']",
                    "x.toml:1:10: kinds[0] = 'hodl': must be one of goto, hold, land; did you mean 'hold'?"},
        FindingCase{"kinds = [3]", "x.toml:1:10: kinds[0] = 3: must be one of goto, hold, land"},
        FindingCase{"gains = 3", "x.toml:1:9: gains = 3: must be a table, written [gains]"},
        FindingCase{"[spare]\nlimit = -1", "x.toml:2:9: spare.limit = -1: must be >= 0 m/s"},
        FindingCase{"fast = 1\nlevel = 11",
                    "x.toml:1:8: fast = 1: must be true or false\n"
                    "x.toml:2:9: level = 11: must be between -10 and 10 V"}),
    [](const auto& test) { return "Case" + std::to_string(test.index); });

TEST(TomlReaderTest, LeavesKeysToOthersThatReadThem) {
  Config config;
  read_toml(parse_toml("check = 1\n", "x.toml"), config, "", {"check"});
  EXPECT_THROW(read_toml(parse_toml("chekc = 1\n", "x.toml"), config, "", {"check"}), ConfigError);
}

TEST(TomlReaderTest, ReadsAMission) {
  Route route;
  read_toml(parse_toml(R"(
cyclic = true
[[waypoints]]
p_N = [0, 0, -5]
heading = "90 deg"
kind = "hold"
hold_time = "500 ms"
[[waypoints]]
geodetic = { latitude = "45 deg", altitude = 100 }
)",
                       "mission.toml"),
            route);
  ASSERT_EQ(route.waypoints.size(), 2u);
  EXPECT_EQ(route.waypoints[0].kind, WaypointKind::kHold);
  EXPECT_EQ(route.waypoints[0].p_N.z(), -5.0);
  EXPECT_EQ(route.waypoints[0].hold_time, 0.5);
  EXPECT_EQ(route.waypoints[1].geodetic->altitude, 100.0);
}

std::string wrong_route(std::string_view text) {
  Route route;
  try {
    read_toml(parse_toml(text, "mission.toml"), route);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TomlReaderTest, ShowsTheRightFormOfAnArrayOfTables) {
  EXPECT_EQ(wrong_route("[waypoints]\nspeed = 1\n"),
            "mission.toml:1:1: waypoints = { speed = 1 }: must be an array of tables: write [[waypoints]] "
            "instead of [waypoints]");
  EXPECT_EQ(wrong_route("waypoints = 3\n"),
            "mission.toml:1:13: waypoints = 3: must be an array of tables, each written [[waypoints]]");
  EXPECT_EQ(wrong_route("waypoints = [3]\n"),
            "mission.toml:1:14: waypoints[0] = 3: must be a table, written [[waypoints]]");
  EXPECT_EQ(wrong_route("[[waypoints]]\ngeodetic = 3\n"),
            "mission.toml:2:12: waypoints[0].geodetic = 3: must be a table, written { key = value }");
}

TEST(TomlReaderTest, SaysInWhichTableAKeyBelongs) {
  EXPECT_EQ(wrong_route("[[waypoints]]\nlatitude = '40 deg'\n"),
            "mission.toml:2:1: waypoints[0].latitude = '40 deg': unknown key, did you mean "
            "'geodetic.latitude'?");
}

TEST(TomlReaderTest, SaysTheBoundsOfAnAngleInDegreesToo) {
  EXPECT_EQ(wrong_route("[[waypoints]]\ngeodetic = { latitude = 95 }\n"),
            "mission.toml:2:25: waypoints[0].geodetic.latitude = 95: must be between -1.5707963267948966 and "
            "1.5707963267948966 rad (-90 and 90 deg)");
}

TEST(TomlReaderTest, KeepsAFindingOnOneLine) {
  EXPECT_EQ(wrong_route("\"a\\nb\" = \"\\u001B[2J\"\n").find('\n'), std::string::npos);
  EXPECT_EQ(wrong_route("\"a\\nb\" = \"\\u001B[2J\"\n").find('\x1B'), std::string::npos);
}

TEST(ApplyTest, SetsOneMemberAndLeavesTheRest) {
  Config config;
  apply(config, "gains.pull", "3");
  apply(config, "period", "1 kHz");
  EXPECT_EQ(config.gains.pull, 3.0);
  EXPECT_EQ(config.gains.order, 2);
  EXPECT_EQ(config.period, milliseconds(1));
}

TEST(ApplyTest, SaysThatTheCommandLineIsWrong) {
  Config config;
  try {
    apply(config, "gains.pull", "30 1/s");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "--set gains.pull=30 1/s: gains.pull = '30 1/s': must be between 0 and 20 1/s");
  }
  try {
    apply(config, "gains.pul", "3");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "--set gains.pul=3: gains.pul = 3: unknown key, did you mean 'pull'?");
  }
}

}  // namespace
}  // namespace ironbird::scenarios
