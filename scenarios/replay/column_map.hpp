#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/replay/text_table.hpp"
#include "simulator/sensors/barometer.hpp"
#include "simulator/sensors/gnss.hpp"
#include "simulator/sensors/magnetometer.hpp"

namespace ironbird::scenarios {

// Which columns of which tables are the sensors of a flight, its truth, and what is to be made from that
// truth. A unit is one of the configuration, or so many of one: `9.80665 m/s^2`; none: SI.

/// A column of numbers.
struct NumberColumn {
  std::string column;
  std::string unit;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("column", self.column, "", "its name");
    visit("unit", self.unit, "", "of its numbers; none: SI");
  }
};

/// When the rows of a table were.
struct TimeColumn {
  std::string column;
  std::string unit;
  hil_bridge::Time offset{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("column", self.column, "", "its name");
    visit("unit", self.unit, "", "of its numbers; none: seconds");
    visit("offset", self.offset, "s", "what is added to come to the clock of the IMU");
  }
};

/// Three columns that are a vector.
struct VectorColumns {
  std::vector<std::string> columns;
  std::string unit;
  std::string axes;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("columns", self.columns, "", "their three names");
    visit("unit", self.unit, "", "of their numbers; none: SI");
    visit("axes", self.axes, "", "where they point; none: front-right-down, or north-east-down");
  }
};

/// A place on the earth.
struct GeodeticColumns {
  NumberColumn latitude;
  NumberColumn longitude;
  NumberColumn altitude;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("latitude", self.latitude, "", "north positive");
    visit("longitude", self.longitude, "", "east positive");
    visit("altitude", self.altitude, "", "above mean sea level");
  }
};

/// Samples of the inertial measurement unit.
struct ImuColumns : TableLayout {
  TimeColumn time;
  VectorColumns gyro;
  VectorColumns accelerometer;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "of a sample");
    visit("gyro", self.gyro, "", "angular velocity, rad/s");
    visit("accelerometer", self.accelerometer, "", "specific force, m/s^2; at rest it points up");
  }
};

/// Samples of a magnetometer.
struct MagnetometerColumns : TableLayout {
  TimeColumn time;
  VectorColumns field;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "of a sample");
    visit("field", self.field, "", "the field, T");
  }
};

/// Samples of a barometer.
struct BarometerColumns : TableLayout {
  TimeColumn time;
  NumberColumn pressure;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "of a sample");
    visit("pressure", self.pressure, "", "absolute static pressure, Pa");
  }
};

/// Fixes of a satellite receiver.
struct GnssColumns : TableLayout {
  TimeColumn time;
  GeodeticColumns place;
  VectorColumns velocity;
  double delay = 0.0;
  double horizontal_accuracy = 2.0;
  double vertical_accuracy = 4.0;
  double speed_accuracy = 0.5;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "when a fix was measured");
    visit("place", self.place, "", "where");
    visit("velocity", self.velocity, "", "over ground, m/s");
    visit("delay", self.delay, "s", "from measurement to arrival", 0.0, 1.0);
    visit("horizontal_accuracy", self.horizontal_accuracy, "m", "what the receiver claims", 0.0, 1e3);
    visit("vertical_accuracy", self.vertical_accuracy, "m", "what the receiver claims", 0.0, 1e3);
    visit("speed_accuracy", self.speed_accuracy, "m/s", "what the receiver claims", 0.0, 1e2);
  }
};

/// Positions of the truth: from the origin, or on the earth.
struct PositionColumns : TableLayout {
  TimeColumn time;
  std::optional<VectorColumns> local;
  std::optional<GeodeticColumns> place;
  std::optional<VectorColumns> velocity;
  double velocity_over = 1.0;
  autopilot::Vector3 p_BA_B = autopilot::Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "of a position");
    visit("local", self.local, "", "from the origin, m");
    visit("place", self.place, "", "on the earth, in place of `local`");
    visit("velocity", self.velocity, "", "over ground, m/s; none: the slope of the positions");
    visit("velocity_over", self.velocity_over, "s", "over which time the slope is taken", 1e-3, 60.0);
    visit("p_BA_B", self.p_BA_B, "m", "where on the body that is whose positions these are, from the IMU",
          -10.0, 10.0);
  }
};

/// Attitudes of the truth: angles or a quaternion.
struct AttitudeColumns : TableLayout {
  TimeColumn time;
  std::vector<std::string> euler;
  std::string unit;
  std::vector<std::string> quaternion;
  std::string body;
  std::string world;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    describe_in(self, visit);
    visit("time", self.time, "", "of an attitude");
    visit(
        "euler", self.euler, "",
        "columns of the angles about the first, second and third axis of `body`, which turn it from `world` "
        "in the order third, second, first: roll, pitch, heading");
    visit("unit", self.unit, "", "of the angles; none: rad");
    visit("quaternion", self.quaternion, "", "columns of w, x, y, z, in place of `euler`");
    visit("body", self.body, "", "where its body's axes point; none: front-right-down");
    visit("world", self.world, "", "where its world's axes point; none: north-east-down");
  }
};

/// What is better known than by an estimator.
struct TruthColumns {
  std::string name = "truth";
  std::optional<PositionColumns> position;
  std::optional<AttitudeColumns> attitude;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "whose it is, for tables and reports");
    visit("position", self.position, "", "and velocity");
    visit("attitude", self.attitude, "", "of the body");
  }
};

/// Sensors that the recording lacks, made from the truth by the simulator's models with their errors.
struct MadeSensors {
  std::uint64_t seed = 1;
  std::optional<simulator::GnssParams> gnss;
  std::optional<simulator::BarometerParams> barometer;
  std::optional<simulator::MagnetometerParams> magnetometer;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("seed", self.seed, "1", "of all noise in them");
    visit("gnss", self.gnss, "", "fixes, from position and velocity");
    visit("barometer", self.barometer, "", "pressures, from the height");
    visit("magnetometer", self.magnetometer, "", "fields, from the attitude and the field of the earth");
  }
};

/// Where and when it flew.
struct FlightPlace {
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  std::optional<double> year;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("latitude", self.latitude, "rad", "of the origin of positions, north positive", -1.57, 1.57);
    visit("longitude", self.longitude, "rad", "of it, east positive", -3.1415926535897931,
          3.1415926535897931);
    visit("altitude", self.altitude, "m", "of it, above mean sea level", -500.0, 9000.0);
    visit("year", self.year, "1", "decimal, for the field of the earth; none: of the newest model", 1900.0,
          2100.0);
  }
};

/// A flight in tables.
struct ColumnMap {
  std::string what;
  std::optional<FlightPlace> place;
  std::optional<ImuColumns> imu;
  std::optional<MagnetometerColumns> magnetometer;
  std::optional<BarometerColumns> barometer;
  std::optional<GnssColumns> gnss;
  std::optional<TruthColumns> truth;
  MadeSensors made;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("what", self.what, "", "what flew");
    visit("place", self.place, "", "where the origin of positions lies");
    visit("imu", self.imu, "", "inertial measurement unit");
    visit("magnetometer", self.magnetometer, "", "field of the earth");
    visit("barometer", self.barometer, "", "pressure");
    visit("gnss", self.gnss, "", "satellite receiver");
    visit("truth", self.truth, "", "what is better known than by an estimator");
    visit("made", self.made, "", "what the recording lacks and is made from the truth");
  }
};

/// A column map with the places in its files.
struct LoadedColumnMap {
  std::filesystem::path file;
  toml::table table;
  ColumnMap map;

  /// A finding about a value: `file:line:column: path: what`. @param path  of a value, or of a table that
  /// lacks one
  ConfigError error(const std::string& path, const std::string& what) const;
};

/// Reads a column map with what it includes. @param settings  paths, with `map.` in front, and texts that are
/// laid over it
/// @throws ConfigError with every finding
LoadedColumnMap load_column_map(const std::filesystem::path& file,
                                const std::vector<std::pair<std::string, std::string>>& settings = {});

}  // namespace ironbird::scenarios
