#pragma once

#include <cstdint>

// What the FCU measures and believes. See messages.hpp.

namespace ironbird::hil_bridge::rosflight {

/// The FCU's own attitude filter, every IMU sample.
struct AttitudeQuaternion {
  static constexpr std::uint8_t kId = 31;
  static constexpr const char* kName = "ATTITUDE_QUATERNION";

  std::uint32_t time_boot_ms{};
  float q1{};
  float q2{};
  float q3{};
  float q4{};
  float rollspeed{};
  float pitchspeed{};
  float yawspeed{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("time_boot_ms", self.time_boot_ms, "ms", "IMU stamp");
    visit("q1", self.q1, "1", "w");
    visit("q2", self.q2, "1", "x");
    visit("q3", self.q3, "1", "y");
    visit("q4", self.q4, "1", "z");
    visit("rollspeed", self.rollspeed, "rad/s", "low-passed, bias removed");
    visit("pitchspeed", self.pitchspeed, "rad/s", "low-passed, bias removed");
    visit("yawspeed", self.yawspeed, "rad/s", "low-passed, bias removed");
  }
};

/// Inertial measurement, every sample.
struct SmallImu {
  static constexpr std::uint8_t kId = 181;
  static constexpr const char* kName = "SMALL_IMU";

  std::uint64_t time_boot_us{};
  float xacc{};
  float yacc{};
  float zacc{};
  float xgyro{};
  float ygyro{};
  float zgyro{};
  float temperature{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("time_boot_us", self.time_boot_us, "us", "FCU clock");
    visit("xacc", self.xacc, "m/s^2", "specific force");
    visit("yacc", self.yacc, "m/s^2", "specific force");
    visit("zacc", self.zacc, "m/s^2", "specific force");
    visit("xgyro", self.xgyro, "rad/s", "angular velocity");
    visit("ygyro", self.ygyro, "rad/s", "angular velocity");
    visit("zgyro", self.zgyro, "rad/s", "angular velocity");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

/// Magnetometer.
struct SmallMag {
  static constexpr std::uint8_t kId = 182;
  static constexpr const char* kName = "SMALL_MAG";

  float xmag{};
  float ymag{};
  float zmag{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("xmag", self.xmag, "1", "field after calibration, in any scale");
    visit("ymag", self.ymag, "1", "field after calibration, in any scale");
    visit("zmag", self.zmag, "1", "field after calibration, in any scale");
  }
};

/// Barometer.
struct SmallBaro {
  static constexpr std::uint8_t kId = 183;
  static constexpr const char* kName = "SMALL_BARO";

  float altitude{};
  float pressure{};
  float temperature{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("altitude", self.altitude, "m", "standard-atmosphere altitude");
    visit("pressure", self.pressure, "Pa", "absolute");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

/// Pitot tube.
struct DiffPressure {
  static constexpr std::uint8_t kId = 184;
  static constexpr const char* kName = "DIFF_PRESSURE";

  float velocity{};
  float diff_pressure{};
  float temperature{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("velocity", self.velocity, "m/s", "indicated airspeed");
    visit("diff_pressure", self.diff_pressure, "Pa", "bias removed");
    visit("temperature", self.temperature, "K", "of the chip");
  }
};

/// Range finder.
struct SmallRange {
  static constexpr std::uint8_t kId = 187;
  static constexpr const char* kName = "SMALL_RANGE";

  float range{};
  float max_range{};
  float min_range{};
  std::uint8_t type{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("range", self.range, "m", "distance");
    visit("max_range", self.max_range, "m", "constant");
    visit("min_range", self.min_range, "m", "constant");
    visit("type", self.type, "1", "0 sonar, 1 lidar");
  }
};

/// Satellite fix.
struct RosflightGnss {
  static constexpr std::uint8_t kId = 197;
  static constexpr const char* kName = "ROSFLIGHT_GNSS";

  std::int64_t seconds{};
  double lat{};
  double lon{};
  std::uint64_t rosflight_timestamp{};
  std::int32_t nanos{};
  float height{};
  float vel_n{};
  float vel_e{};
  float vel_d{};
  float h_acc{};
  float v_acc{};
  float s_acc{};
  std::uint8_t fix_type{};
  std::uint8_t num_sat{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("seconds", self.seconds, "s", "Unix time");
    visit("lat", self.lat, "deg", "north positive");
    visit("lon", self.lon, "deg", "east positive");
    visit("rosflight_timestamp", self.rosflight_timestamp, "us", "FCU clock at which the fix was valid");
    visit("nanos", self.nanos, "ns", "fraction of the Unix second");
    visit("height", self.height, "m", "above mean sea level");
    visit("vel_n", self.vel_n, "m/s", "velocity north");
    visit("vel_e", self.vel_e, "m/s", "velocity east");
    visit("vel_d", self.vel_d, "m/s", "velocity down");
    visit("h_acc", self.h_acc, "m", "horizontal accuracy");
    visit("v_acc", self.v_acc, "m", "vertical accuracy");
    visit("s_acc", self.s_acc, "m/s", "speed accuracy");
    visit("fix_type", self.fix_type, "1", "kind of fix");
    visit("num_sat", self.num_sat, "1", "satellites");
  }
};

/// Battery monitor.
struct RosflightBatteryStatus {
  static constexpr std::uint8_t kId = 199;
  static constexpr const char* kName = "ROSFLIGHT_BATTERY_STATUS";

  float battery_voltage{};
  float battery_current{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("battery_voltage", self.battery_voltage, "V", "low-passed");
    visit("battery_current", self.battery_current, "A", "low-passed");
  }
};

}  // namespace ironbird::hil_bridge::rosflight
