#pragma once

#include <array>
#include <optional>

#include "simulator/types/linear_algebra.hpp"
#include "simulator/types/time.hpp"

namespace ironbird::simulator {

// What the sensor chips deliver to the flight-control unit. `taken` is when the quantity was true; a reading
// appears in Readings at `taken` plus the sensor's latency.

struct ImuReading {
  Time taken{};
  Vector3 f_B = Vector3::Zero();
  Vector3 w_NB_B = Vector3::Zero();
  double temperature = 300.15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("f_B", self.f_B, "m/s^2", "specific force");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

struct MagReading {
  Time taken{};
  Vector3 m_B = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("m_B", self.m_B, "T", "magnetic field, hard and soft iron included");
  }
};

struct BaroReading {
  Time taken{};
  double pressure = 101325.0;
  double temperature = 288.15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("pressure", self.pressure, "Pa", "absolute static pressure");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

struct GnssReading {
  Time taken{};
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  Vector3 v_NB_N = Vector3::Zero();
  double horizontal_accuracy = 0.0;
  double vertical_accuracy = 0.0;
  double speed_accuracy = 0.0;
  int fix = 0;
  int satellites = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("latitude", self.latitude, "rad", "geodetic latitude");
    visit("longitude", self.longitude, "rad", "longitude");
    visit("altitude", self.altitude, "m", "height above mean sea level");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity over ground");
    visit("horizontal_accuracy", self.horizontal_accuracy, "m", "the receiver's own estimate");
    visit("vertical_accuracy", self.vertical_accuracy, "m", "the receiver's own estimate");
    visit("speed_accuracy", self.speed_accuracy, "m/s", "the receiver's own estimate");
    visit("fix", self.fix, "1", "0 none, 3 three-dimensional, 6 and 7 RTK float and fixed");
    visit("satellites", self.satellites, "1", "in use");
  }
};

struct RangeReading {
  Time taken{};
  double range = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("range", self.range, "m", "distance to the ground along the sensor's axis");
  }
};

struct AirspeedReading {
  Time taken{};
  double differential_pressure = 0.0;
  double temperature = 288.15;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("differential_pressure", self.differential_pressure, "Pa", "pitot minus static pressure");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

struct BatteryReading {
  Time taken{};
  double voltage = 0.0;
  double current = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("taken", self.taken, "ns", "when it was true");
    visit("voltage", self.voltage, "V", "at the terminals");
    visit("current", self.current, "A", "drawn");
  }
};

/// What arrived at the flight-control unit in the last step: at most one of each.
struct Readings {
  std::optional<ImuReading> imu;
  std::optional<MagReading> mag;
  std::optional<BaroReading> baro;
  std::optional<GnssReading> gnss;
  std::optional<RangeReading> range;
  std::optional<AirspeedReading> airspeed;
  std::optional<BatteryReading> battery;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("imu", self.imu, "", "inertial measurement unit");
    visit("mag", self.mag, "", "magnetometer");
    visit("baro", self.baro, "", "barometer");
    visit("gnss", self.gnss, "", "satellite receiver");
    visit("range", self.range, "", "range finder");
    visit("airspeed", self.airspeed, "", "differential pressure");
    visit("battery", self.battery, "", "battery monitor");
  }
};

}  // namespace ironbird::simulator
