#pragma once

#include <array>
#include <cstdint>
#include <variant>

// The vocabulary of the ROSflight 2.0 link: its 25 messages as plain structs, with the names, types and units
// of the wire. Members stand in wire order. `kId` and `kName` are those of the dialect; lengths and check
// bytes are computed from `describe`.

namespace ironbird::hil_bridge::rosflight {

/// Sign of life, 1 Hz each way.
struct Heartbeat {
  static constexpr std::uint8_t kId = 0;
  static constexpr const char* kName = "HEARTBEAT";

  std::uint32_t custom_mode{};
  std::uint8_t type{};
  std::uint8_t autopilot{};
  std::uint8_t base_mode{};
  std::uint8_t system_status{};
  std::uint8_t mavlink_version{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("custom_mode", self.custom_mode, "1", "unused");
    visit("type", self.type, "1", "2 multirotor, 1 fixed wing, 0 companion");
    visit("autopilot", self.autopilot, "1", "unused");
    visit("base_mode", self.base_mode, "1", "unused");
    visit("system_status", self.system_status, "1", "unused");
    visit("mavlink_version", self.mavlink_version, "1", "constant of the dialect");
  }
};

/// Asks for one parameter, by index or, with a negative index, by name.
struct ParamRequestRead {
  static constexpr std::uint8_t kId = 20;
  static constexpr const char* kName = "PARAM_REQUEST_READ";

  std::int16_t param_index{};
  std::uint8_t target_system{};
  std::uint8_t target_component{};
  std::array<char, 16> param_id{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("param_index", self.param_index, "1", "index, or negative: by name");
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
  }
};

/// Asks for all parameters.
struct ParamRequestList {
  static constexpr std::uint8_t kId = 21;
  static constexpr const char* kName = "PARAM_REQUEST_LIST";

  std::uint8_t target_system{};
  std::uint8_t target_component{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
  }
};

/// One parameter.
struct ParamValue {
  static constexpr std::uint8_t kId = 22;
  static constexpr const char* kName = "PARAM_VALUE";

  std::uint32_t param_value{};
  std::uint16_t param_count{};
  std::uint16_t param_index{};
  std::array<char, 16> param_id{};
  std::uint8_t param_type{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("param_value", self.param_value, "1", "bits of an int32 or a float32");
    visit("param_count", self.param_count, "1", "how many parameters there are");
    visit("param_index", self.param_index, "1", "index of this one");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
    visit("param_type", self.param_type, "1", "6 int32, 9 float32");
  }
};

/// Sets one parameter.
struct ParamSet {
  static constexpr std::uint8_t kId = 23;
  static constexpr const char* kName = "PARAM_SET";

  std::uint32_t param_value{};
  std::uint8_t target_system{};
  std::uint8_t target_component{};
  std::array<char, 16> param_id{};
  std::uint8_t param_type{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("param_value", self.param_value, "1", "bits of an int32 or a float32");
    visit("target_system", self.target_system, "1", "SYS_ID of the FCU");
    visit("target_component", self.target_component, "1", "ignored");
    visit("param_id", self.param_id, "", "name, zero padded, unterminated when 16 long");
    visit("param_type", self.param_type, "1", "6 int32, 9 float32");
  }
};

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
  static void describe(Self& self, Visit&& visit) {
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

/// The pilot's sticks and switches.
struct RcChannels {
  static constexpr std::uint8_t kId = 65;
  static constexpr const char* kName = "RC_CHANNELS";

  std::uint32_t time_boot_ms{};
  std::array<std::uint16_t, 18> chan_raw{};
  std::uint8_t chancount{};
  std::uint8_t rssi{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("time_boot_ms", self.time_boot_ms, "ms", "receive time");
    visit("chan_raw", self.chan_raw, "us", "pulse widths; only the first eight are filled");
    visit("chancount", self.chancount, "1", "always 0");
    visit("rssi", self.rssi, "1", "always 0");
  }
};

/// Clock comparison.
struct Timesync {
  static constexpr std::uint8_t kId = 111;
  static constexpr const char* kName = "TIMESYNC";

  std::int64_t tc1{};
  std::int64_t ts1{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("tc1", self.tc1, "ns", "FCU clock, 0 in a request");
    visit("ts1", self.ts1, "ns", "companion clock, echoed");
  }
};

/// The companion's command.
struct OffboardControl {
  static constexpr std::uint8_t kId = 180;
  static constexpr const char* kName = "OFFBOARD_CONTROL";

  std::array<float, 10> u{};
  std::uint16_t ignore{};
  std::uint8_t mode{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("u", self.u, "SI", "forces, torques or their setpoints, then free mixer inputs");
    visit("ignore", self.ignore, "1", "bit i: u[i] is not commanded");
    visit("mode", self.mode, "1", "0 pass-through, 1 rates, 2 angles");
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
  static void describe(Self& self, Visit&& visit) {
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
  static void describe(Self& self, Visit&& visit) {
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
  static void describe(Self& self, Visit&& visit) {
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
  static void describe(Self& self, Visit&& visit) {
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
  static void describe(Self& self, Visit&& visit) {
    visit("range", self.range, "m", "distance");
    visit("max_range", self.max_range, "m", "constant");
    visit("min_range", self.min_range, "m", "constant");
    visit("type", self.type, "1", "0 sonar, 1 lidar");
  }
};

/// A command to the FCU's housekeeping.
struct RosflightCmd {
  static constexpr std::uint8_t kId = 188;
  static constexpr const char* kName = "ROSFLIGHT_CMD";

  std::uint8_t command{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("command", self.command, "1", "which");
  }
};

/// Answer to a command.
struct RosflightCmdAck {
  static constexpr std::uint8_t kId = 189;
  static constexpr const char* kName = "ROSFLIGHT_CMD_ACK";

  std::uint8_t command{};
  std::uint8_t success{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("command", self.command, "1", "which");
    visit("success", self.success, "1", "0 failed, 1 accepted");
  }
};

/// What the outputs are driven with, every eighth IMU sample.
struct RosflightOutputRaw {
  static constexpr std::uint8_t kId = 190;
  static constexpr const char* kName = "ROSFLIGHT_OUTPUT_RAW";

  std::uint64_t stamp{};
  std::array<float, 14> values{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ms", "FCU clock");
    visit("values", self.values, "1", "motors 0..1, servos 0..1 with 0.5 in the centre");
  }
};

/// State of the FCU.
struct RosflightStatus {
  static constexpr std::uint8_t kId = 191;
  static constexpr const char* kName = "ROSFLIGHT_STATUS";
  static constexpr std::uint8_t kUncalibratedImu = 0x20;  ///< of error_code

  std::uint16_t rc_override{};
  std::int16_t num_errors{};
  std::int16_t loop_time_us{};
  std::uint8_t armed{};
  std::uint8_t failsafe{};
  std::uint8_t offboard{};
  std::uint8_t error_code{};
  std::uint8_t control_mode{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("rc_override", self.rc_override, "1", "bits: which axes the pilot holds and why");
    visit("num_errors", self.num_errors, "1", "sensor read errors");
    visit("loop_time_us", self.loop_time_us, "us", "duration of the control pass");
    visit("armed", self.armed, "1", "motors may turn");
    visit("failsafe", self.failsafe, "1", "flies the failsafe command");
    visit("offboard", self.offboard, "1", "a command of the companion is active");
    visit("error_code", self.error_code, "1", "bits: faults");
    visit("control_mode", self.control_mode, "1", "0 pass-through, 1 rates, 2 angles");
  }
};

/// Version text.
struct RosflightVersion {
  static constexpr std::uint8_t kId = 192;
  static constexpr const char* kName = "ROSFLIGHT_VERSION";

  std::array<char, 50> version{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("version", self.version, "", "zero padded");
  }
};

/// Commands to auxiliary outputs.
struct RosflightAuxCmd {
  static constexpr std::uint8_t kId = 193;
  static constexpr const char* kName = "ROSFLIGHT_AUX_CMD";

  std::array<float, 14> aux_cmd_array{};
  std::array<std::uint8_t, 14> type_array{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("aux_cmd_array", self.aux_cmd_array, "1", "one per pin");
    visit("type_array", self.type_array, "1", "0 disabled, 1 servo, 2 motor");
  }
};

/// An attitude from outside for the FCU's filter.
struct ExternalAttitude {
  static constexpr std::uint8_t kId = 195;
  static constexpr const char* kName = "EXTERNAL_ATTITUDE";

  float qw{};
  float qx{};
  float qy{};
  float qz{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("qw", self.qw, "1", "body to world");
    visit("qx", self.qx, "1", "body to world");
    visit("qy", self.qy, "1", "body to world");
    visit("qz", self.qz, "1", "body to world");
  }
};

/// Report after a recovered hard fault.
struct RosflightHardError {
  static constexpr std::uint8_t kId = 196;
  static constexpr const char* kName = "ROSFLIGHT_HARD_ERROR";

  std::uint32_t error_code{};
  std::uint32_t pc{};
  std::uint32_t reset_count{};
  std::uint32_t do_rearm{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("error_code", self.error_code, "1", "bits at the crash");
    visit("pc", self.pc, "1", "program counter");
    visit("reset_count", self.reset_count, "1", "resets so far");
    visit("do_rearm", self.do_rearm, "1", "1 if it was armed");
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
  static void describe(Self& self, Visit&& visit) {
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
  static void describe(Self& self, Visit&& visit) {
    visit("battery_voltage", self.battery_voltage, "V", "low-passed");
    visit("battery_current", self.battery_current, "A", "low-passed");
  }
};

/// A line of log text.
struct Statustext {
  static constexpr std::uint8_t kId = 253;
  static constexpr const char* kName = "STATUSTEXT";

  std::uint8_t severity{};
  std::array<char, 50> text{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("severity", self.severity, "1", "0 emergency .. 7 debug");
    visit("text", self.text, "", "zero padded, at most 49 characters");
  }
};

using Message =
    std::variant<Heartbeat, ParamRequestRead, ParamRequestList, ParamValue, ParamSet, AttitudeQuaternion,
                 RcChannels, Timesync, OffboardControl, SmallImu, SmallMag, SmallBaro, DiffPressure,
                 SmallRange, RosflightCmd, RosflightCmdAck, RosflightOutputRaw, RosflightStatus,
                 RosflightVersion, RosflightAuxCmd, ExternalAttitude, RosflightHardError, RosflightGnss,
                 RosflightBatteryStatus, Statustext>;

}  // namespace ironbird::hil_bridge::rosflight
