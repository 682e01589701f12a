// Flights in tables by hand: which column becomes which message, what is made from truth, and what is said of
// a map that does not fit.

#include "scenarios/replay/csv_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/math/euler_zyx.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/direction_axes.hpp"
#include "scenarios/replay/truth_track.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Quaternion;
using autopilot::Vector3;
using hil_bridge::Time;
using std::chrono::milliseconds;
using testing::Contains;
using testing::HasSubstr;
namespace rosflight = hil_bridge::rosflight;

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kFloat = 1e-6;  // relative, of what goes over the wire

/// A folder with a map and its tables.
class TablesByHand : public testing::Test {
 protected:
  TablesByHand()
      : folder_(std::filesystem::path(testing::TempDir()) / ("ironbird_tables_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    // Four seconds level at 100 Hz, turning; 2 m/s to the north, sinking.
    std::string imu = "time,gx,gy,gz,ax,ay,az\n";
    for (int k = 0; k <= 400; ++k) imu += std::to_string(1000.0 + 0.01 * k) + ",10,20,30,1,2,9.8\n";
    write("imu.csv", imu);
    std::string truth = "ms,north,east,down,roll,pitch,heading\n";
    for (int k = 0; k <= 40; ++k) {
      truth += std::to_string(999900 + 100 * k) + "," + std::to_string(0.2 * k) + ",5," +
               std::to_string(-10.0 + 0.05 * k) + ",0,0,90\n";
    }
    write("truth.csv", truth);
  }
  ~TablesByHand() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  CsvFlight read(const std::string& map,
                 const std::vector<std::pair<std::string, std::string>>& settings = {}) const {
    write("map.toml", map);
    return read_csv_flight(load_column_map(folder_ / "map.toml", settings));
  }
  /// What is said of a map, without the name of the folder.
  std::string complaint(const std::string& map,
                        const std::vector<std::pair<std::string, std::string>>& settings = {}) const {
    try {
      read(map, settings);
    } catch (const UserError& error) {
      std::string text = error.what();
      const std::string folder = folder_.string() + "/";
      for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
        text.erase(at, folder.size());
      return text;
    }
    return "none";
  }

  static std::string imu() {
    return R"([imu]
file = "imu.csv"
time = { column = "time" }
gyro = { columns = ["gx", "gy", "gz"], unit = "deg/s", axes = "front-left-up" }
accelerometer = { columns = ["ax", "ay", "az"], axes = "front-left-up" }
)";
  }
  static std::string truth() {
    return R"([truth]
name = "RTK"
[truth.position]
file = "truth.csv"
time = { column = "ms", unit = "ms", offset = "0.1 s" }
local = { columns = ["north", "east", "down"] }
[truth.attitude]
file = "truth.csv"
time = { column = "ms", unit = "ms", offset = "0.1 s" }
euler = ["roll", "pitch", "heading"]
unit = "deg"
)";
  }
  static std::string place() {
    return "[place]\nlatitude = \"48 deg\"\nlongitude = \"11 deg\"\naltitude = \"500 m\"\nyear = 2024\n";
  }

  std::filesystem::path folder_;
};

template <class Content>
std::vector<std::pair<Time, Content>> of(const CsvFlight& csv) {
  std::vector<std::pair<Time, Content>> found;
  for (const hil_bridge::Arrival& arrival : csv.flight.messages) {
    if (const auto* content = std::get_if<Content>(&arrival.message))
      found.emplace_back(arrival.when, *content);
  }
  return found;
}

using CsvFlightTest = TablesByHand;

TEST_F(CsvFlightTest, TurnsTheSensorsAxesAndUnits) {
  const CsvFlight csv = read(imu());
  const auto samples = of<rosflight::SmallImu>(csv);
  ASSERT_EQ(samples.size(), 401U);
  EXPECT_EQ(samples.front().first, Time::zero());
  EXPECT_EQ(samples.back().first, csv.flight.end);
  EXPECT_NEAR(static_cast<double>(csv.flight.end.count()), 4e9, 1e3);
  const rosflight::SmallImu& sample = samples.back().second;
  EXPECT_EQ(sample.xacc, 1.0F);
  EXPECT_EQ(sample.yacc, -2.0F);
  EXPECT_EQ(sample.zacc, -9.8F);
  EXPECT_NEAR(sample.xgyro, 10.0 * kRadians, kFloat);
  EXPECT_NEAR(sample.ygyro, -20.0 * kRadians, kFloat);
  EXPECT_NEAR(sample.zgyro, -30.0 * kRadians, kFloat);
  for (const auto& [when, status] : of<rosflight::RosflightStatus>(csv)) EXPECT_EQ(status.armed, 1);
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("it has no GNSS fixes")));
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("it has no truth")));
}

TEST_F(CsvFlightTest, TakesSoManyOfAUnit) {
  const CsvFlight csv = read(imu(), {{"map.imu.accelerometer.unit", "9.80665 m/s^2"}});
  EXPECT_NEAR(of<rosflight::SmallImu>(csv).front().second.xacc, 9.80665, 1e-5);
}

TEST_F(CsvFlightTest, ReadsSlowSensorsOnTheClockOfTheImu) {
  write(
      "slow.csv",
      "t,lat,lon,alt,ve,vn,vu,mx,my,mz,p\n999,48,11,500,1,2,3,200,0,400,950\n1001.5,48.001,11.002,510,1,2,3,"
      "200,10,400,950.5\n");
  const std::string time = "file = \"slow.csv\"\ntime = { column = \"t\" }\n";
  const CsvFlight csv = read(
      imu() + "[gnss]\n" + time +
      "place = { latitude = { column = \"lat\", unit = \"deg\" }, longitude = { column = \"lon\", unit = "
      "\"deg\" }, altitude = { column = \"alt\" } }\n"
      "velocity = { columns = [\"ve\", \"vn\", \"vu\"], axes = \"east-north-up\" }\ndelay = \"0.2 s\"\n" +
      "[magnetometer]\n" + time + "field = { columns = [\"mx\", \"my\", \"mz\"], unit = \"mgauss\" }\n" +
      "[barometer]\n" + time + "pressure = { column = \"p\", unit = \"hPa\" }\n");
  const auto fixes = of<rosflight::RosflightGnss>(csv);
  ASSERT_EQ(fixes.size(), 1U) << "the first is from before the IMU's";
  EXPECT_EQ(fixes[0].first, milliseconds(1700));
  EXPECT_EQ(fixes[0].second.rosflight_timestamp, 1'500'000U);
  EXPECT_NEAR(fixes[0].second.lat, 48.001, 1e-9);
  EXPECT_NEAR(fixes[0].second.lon, 11.002, 1e-9);
  EXPECT_EQ(fixes[0].second.height, 510.0F);
  EXPECT_EQ(fixes[0].second.vel_n, 2.0F);
  EXPECT_EQ(fixes[0].second.vel_e, 1.0F);
  EXPECT_EQ(fixes[0].second.vel_d, -3.0F);
  const auto fields = of<rosflight::SmallMag>(csv);
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_NEAR(fields[0].second.ymag, 1e-6, 1e-12);
  const auto pressures = of<rosflight::SmallBaro>(csv);
  ASSERT_EQ(pressures.size(), 1U);
  EXPECT_EQ(pressures[0].second.pressure, 95050.0F);
  ASSERT_TRUE(csv.field);
  EXPECT_FALSE(csv.dated);
}

TEST_F(CsvFlightTest, ReadsTruthWithTheSlopeOfItsPositions) {
  const CsvFlight csv = read(place() + imu() + truth());
  ASSERT_EQ(csv.flight.estimates.size(), 1U);
  const RecordedEstimate& rtk = csv.flight.estimates.front();
  EXPECT_EQ(rtk.name, "RTK");
  EXPECT_TRUE(rtk.origin.known);
  EXPECT_NEAR(rtk.origin.latitude, 48.0 * kRadians, 1e-12);
  ASSERT_EQ(rtk.positions.size(), 41U);
  EXPECT_EQ(rtk.positions[1].stamp, milliseconds(100));
  EXPECT_NEAR((rtk.positions[1].p_NB_N - Vector3(0.2, 5.0, -9.95)).norm(), 0.0, 1e-12);
  EXPECT_FALSE(rtk.positions[4].velocity_known) << "half a second on either side is needed";
  ASSERT_TRUE(rtk.positions[5].velocity_known);
  EXPECT_NEAR((rtk.positions[5].v_NB_N - Vector3(2.0, 0.0, 0.5)).norm(), 0.0, 1e-9);
  ASSERT_EQ(rtk.attitudes.size(), 41U);
  EXPECT_NEAR(autopilot::euler_from_quaternion(rtk.attitudes[0].q_NB).z(), 0.5 * std::numbers::pi, 1e-12);
  EXPECT_THAT(csv.flight.remarks, Contains("RTK's velocity is the slope of its positions over 1 s"));
}

TEST_F(CsvFlightTest, TakesPositionsToTheImu) {
  const CsvFlight csv = read(imu() + truth(), {{"map.truth.position.p_BA_B", "[1, 0, -0.5]"}});
  // Its nose is to the east.
  EXPECT_NEAR((csv.flight.estimates[0].positions[1].p_NB_N - Vector3(0.2, 4.0, -9.45)).norm(), 0.0, 1e-9);
}

TEST_F(CsvFlightTest, TurnsAttitudesOfOtherAxes) {
  // Nose to the north-east, right wing 20 degrees down, told of front-left-up axes in east-north-up ones.
  const Quaternion q_WA = Quaternion(Eigen::AngleAxisd(45.0 * kRadians, Vector3::UnitZ())) *
                          Quaternion(Eigen::AngleAxisd(20.0 * kRadians, Vector3::UnitX()));
  write("attitude.csv", "t;x;y;z;w\n1001;" + std::to_string(q_WA.x()) + ";" + std::to_string(q_WA.y()) + ";" +
                            std::to_string(q_WA.z()) + ";" + std::to_string(q_WA.w()) + "\n1002;0;0;0;0\n");
  const CsvFlight csv = read(imu() + R"([truth.attitude]
file = "attitude.csv"
delimiter = ";"
time = { column = "t" }
quaternion = ["w", "x", "y", "z"]
body = "front-left-up"
world = "east-north-up"
)");
  const auto& attitudes = csv.flight.estimates.at(0).attitudes;
  ASSERT_EQ(attitudes.size(), 1U);
  const Vector3 theta = autopilot::euler_from_quaternion(attitudes[0].q_NB);
  EXPECT_NEAR((theta - Vector3(20.0, 0.0, 45.0) * kRadians).norm(), 0.0, 1e-5);
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("1 quaternions are no rotations")));
}

TEST_F(CsvFlightTest, MakesSensorsOfTheTruth) {
  const std::string made =
      "[made.gnss]\ntiming = { rate = 5, latency = \"0.1 s\" }\n[made.barometer]\ntiming = { rate = 10 }\n"
      "[made.magnetometer]\ntiming = { rate = 10 }\n";
  const CsvFlight csv = read(place() + imu() + truth() + made);
  const auto fixes = of<rosflight::RosflightGnss>(csv);
  ASSERT_EQ(fixes.size(), 15U) << "from 0.6 to 3.4 s, between the first slope and the last";
  const auto& [arrived, fix] = fixes.front();
  EXPECT_EQ(arrived, milliseconds(700));
  EXPECT_EQ(fix.rosflight_timestamp, 600'000U);
  constexpr double kMetresPerDegree = 6378145.0 * kRadians;
  EXPECT_NEAR((fix.lat - 48.0) * kMetresPerDegree, 1.2, 1e-6);
  EXPECT_NEAR((fix.lon - 11.0) * kMetresPerDegree * std::cos(48.0 * kRadians), 5.0, 1e-6);
  EXPECT_NEAR(fix.height, 509.7, 1e-4);
  EXPECT_NEAR(fix.vel_n, 2.0, 1e-6);
  EXPECT_NEAR(fix.vel_d, 0.5, 1e-6);
  const auto pressures = of<rosflight::SmallBaro>(csv);
  ASSERT_EQ(pressures.size(), 40U);
  EXPECT_GT(pressures.back().second.pressure, pressures.front().second.pressure) << "it sinks";
  const auto fields = of<rosflight::SmallMag>(csv);
  ASSERT_FALSE(fields.empty());
  ASSERT_TRUE(csv.field);
  const Vector3& earth_N = csv.field->b_N;  // with the nose to the east, N's north is on the left
  EXPECT_NEAR(fields[0].second.xmag, earth_N.y(), 1e-9);
  EXPECT_NEAR(fields[0].second.ymag, -earth_N.x(), 1e-9);
  EXPECT_NEAR(fields[0].second.zmag, earth_N.z(), 1e-9);
  EXPECT_THAT(csv.flight.what, HasSubstr("(GNSS fixes, barometer, magnetometer made from RTK)"));
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("GNSS fixes made from RTK, not recorded: 15 at 5 Hz")));
}

TEST_F(CsvFlightTest, MakesTheSameNoiseOfTheSameSeed) {
  const std::string map = place() + imu() + truth() + "[made.gnss]\nhorizontal = { noise_sigma = 0.3 }\n";
  const auto latitudes = [&](const char* seed) {
    std::vector<double> all;
    for (const auto& [when, fix] : of<rosflight::RosflightGnss>(read(map, {{"map.made.seed", seed}})))
      all.push_back(fix.lat);
    return all;
  };
  EXPECT_EQ(latitudes("3"), latitudes("3"));
  EXPECT_NE(latitudes("3"), latitudes("4"));
  EXPECT_THAT(read(map).flight.remarks, Contains(HasSubstr("white 0.3 m horizontally; no noise vertically")));
}

TEST_F(CsvFlightTest, LeavesOutRowsThatAreNotWholeOrNotInOrder) {
  write(
      "imu.csv",
      "time,gx,gy,gz,ax,ay,az\n0,0,0,0,0,0,9.8\n1e9,0,0,0,0,0,9.8\n0.01,0,0,0,nan,0,9.8\n0.02,0,0,0,0,0,9.8\n"
      "0.03,0,0,0\n0.01,0,0,0,0,0,9.8\n0.04,0,0,0,0,0,9.8\n0.05,0,0,0,0,0,9.8\n");
  const CsvFlight csv = read(imu());
  EXPECT_EQ(of<rosflight::SmallImu>(csv).size(), 4U);
  EXPECT_THAT(csv.flight.remarks,
              Contains(testing::AllOf(HasSubstr("imu: 2 rows left out; the first: "),
                                      HasSubstr("imu.csv:4: column 'ax' is no number: 'nan'"))));
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("imu: 2 rows left out whose time is out of order")));
}

TEST_F(CsvFlightTest, DoesNotFlyForYears) {
  write(
      "imu.csv",
      "time,gx,gy,gz,ax,ay,az\n0,0,0,0,0,0,9.8\n0.01,0,0,0,0,0,9.8\n3e9,0,0,0,0,0,9.8\n9e9,0,0,0,0,0,9.8\n");
  const CsvFlight csv = read(imu());
  EXPECT_EQ(csv.flight.end, milliseconds(10));
  EXPECT_THAT(csv.flight.remarks, Contains("imu: 1 rows more than ten days after the first left out"));
  EXPECT_THAT(csv.flight.remarks, Contains(HasSubstr("imu: 1 rows left out whose time is out of order")));
}

struct WrongMap {
  const char* name;
  std::pair<std::string, std::string> setting;
  const char* complaint;
};
class WrongMapTest : public TablesByHand, public testing::WithParamInterface<WrongMap> {};

TEST_P(WrongMapTest, IsSaidWithItsPlace) {
  const auto& [path, text] = GetParam().setting;
  EXPECT_EQ(complaint(place() + imu() + truth() + "[made.gnss]\n", {GetParam().setting}),
            (GetParam().complaint[0] == '-' ? "--set " + path + "=" + text + ": " : "map.toml:") +
                std::string(GetParam().complaint + 1));
}

INSTANTIATE_TEST_SUITE_P(
    Known, WrongMapTest,
    testing::Values(
        WrongMap{"file",
                 {"map.imu.file", "imu.cvs"},
                 "-imu.file: there is no file imu.cvs; did you mean imu.csv?"},
        WrongMap{"folder",
                 {"map.imu.file", "elsewhere/table"},
                 "-imu.file: there is no file elsewhere/table; --data names the folder of the tables"},
        WrongMap{"column",
                 {"map.imu.time.column", "tme"},
                 "-imu.time.column: imu.csv:1: there is no column 'tme'; did you mean 'time'?"},
        WrongMap{"unit", {"map.imu.gyro.unit", "m"}, "-imu.gyro.unit: found 'm', needs rad/s, deg/s or rpm"},
        WrongMap{"axes",
                 {"map.imu.gyro.axes", "front-left-down"},
                 "-imu.gyro.axes: is left-handed; turn one of the three round"},
        WrongMap{"direction",
                 {"map.truth.position.local.axes", "east-north-zenith"},
                 "-truth.position.local.axes: 'zenith' is no direction; there are north, south, east, west, "
                 "down, up"},
        WrongMap{"two_columns",
                 {"map.imu.gyro.columns", "[\"gx\", \"gy\"]"},
                 "-imu.gyro.columns: must name 3 columns; it names 2"},
        WrongMap{"no_accelerometer",
                 {"map.imu.accelerometer.columns", "[]"},
                 "-imu.accelerometer.columns: is missing: an estimator needs specific forces"},
        WrongMap{"both_attitudes",
                 {"map.truth.attitude.quaternion", "[\"a\", \"b\", \"c\", \"d\"]"},
                 ":17:1: truth.attitude: must have either `euler` or `quaternion`"},
        WrongMap{"antenna",
                 {"map.made.gnss.p_BA_B", "[0, 0, 1]"},
                 "-made.gnss.p_BA_B: must be 0: the antenna is where truth.position is"},
        WrongMap{"delimiter", {"map.imu.delimiter", "\"\""}, "-imu.delimiter: must not be empty"}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST_F(CsvFlightTest, SaysWhatIsMissing) {
  EXPECT_EQ(complaint(truth()), "map.toml: imu: is missing: without an IMU there is nothing to replay");
  EXPECT_EQ(complaint(imu() + "[made.gnss]\n"),
            "map.toml:6:1: made.gnss: is made from truth.position: there is none");
  EXPECT_EQ(complaint(imu() + truth() + "[made.gnss]\n"),
            "map.toml: place: is missing: sensors are made for a place, its pressure and its field");
  EXPECT_THAT(complaint("[imu]\nfiel = \"imu.csv\"\n"), HasSubstr("map.toml:2:1: imu.fiel"));
  EXPECT_THAT(complaint("[imu]\nfiel = \"imu.csv\"\n"), HasSubstr("did you mean 'file'?"));
  write("imu.csv", "time,gx,gy,gz,ax,ay,az\n");
  EXPECT_EQ(complaint(imu()), "imu.csv: has no IMU samples");
  write("imu.csv", "");
  EXPECT_EQ(complaint(imu()), "map.toml:2:8: imu.file: imu.csv: is empty");
}

TEST(DirectionAxesTest, TakesOnlyRightHandedAxes) {
  EXPECT_TRUE(north_from_axes("north-east-down").isIdentity());
  EXPECT_EQ(Vector3(north_from_axes("east-north-up") * Vector3(1.0, 2.0, 3.0)), Vector3(2.0, 1.0, -3.0));
  EXPECT_EQ(Vector3(body_from_axes("right-front-up") * Vector3(1.0, 2.0, 3.0)), Vector3(2.0, 1.0, -3.0));
  for (const char* axes :
       {"", "front", "front-left-up-up", "front-front-up", "front-right-up", "north-east-down"})
    EXPECT_THROW(body_from_axes(axes), AxesError) << axes;
}

TEST(TruthTrackTest, GivesTheSlopeOfACubicExactly) {
  std::vector<RecordedPosition> positions;
  for (int k = 0; k <= 20; ++k) {
    const double t = 0.1 * k;
    RecordedPosition position;
    position.stamp = milliseconds(100 * k);
    position.p_NB_N = {t * t * t, 2.0 * t * t, -t};
    positions.push_back(position);
  }
  add_slopes(positions, 0.6);
  ASSERT_TRUE(positions[10].velocity_known);
  EXPECT_NEAR((positions[10].v_NB_N - Vector3(3.0, 4.0, -1.0)).norm(), 0.0, 1e-9);
  add_slopes(positions, 0.2);
  EXPECT_FALSE(positions[10].velocity_known) << "three positions are no cubic";
}

TEST(TruthTrackTest, SaysNothingWhereNothingIsKnown) {
  RecordedEstimate truth;
  for (const int ms : {0, 100, 3000}) {
    RecordedPosition position;
    position.stamp = milliseconds(ms);
    position.p_NB_N.x() = 0.01 * ms;
    truth.positions.push_back(position);
  }
  const TruthTrack track(truth);
  ASSERT_TRUE(track.position(milliseconds(25)));
  EXPECT_NEAR(track.position(milliseconds(25))->x(), 0.25, 1e-12);
  EXPECT_TRUE(track.position(milliseconds(3000)));
  for (const int ms : {-1, 101, 2000, 3001}) EXPECT_FALSE(track.position(milliseconds(ms))) << ms;
  EXPECT_FALSE(track.attitude(milliseconds(0)));
}

}  // namespace
}  // namespace ironbird::scenarios
