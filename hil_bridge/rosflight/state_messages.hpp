#pragma once

#include <array>
#include <cstdint>

// Signs of life, clocks, and how the FCU itself is doing. See messages.hpp.

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
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("custom_mode", self.custom_mode, "1", "unused");
    visit("type", self.type, "1", "2 multirotor, 1 fixed wing, 0 companion");
    visit("autopilot", self.autopilot, "1", "unused");
    visit("base_mode", self.base_mode, "1", "unused");
    visit("system_status", self.system_status, "1", "unused");
    visit("mavlink_version", self.mavlink_version, "1", "constant of the dialect");
  }
};

/// Clock comparison.
struct Timesync {
  static constexpr std::uint8_t kId = 111;
  static constexpr const char* kName = "TIMESYNC";

  std::int64_t tc1{};
  std::int64_t ts1{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("tc1", self.tc1, "ns", "FCU clock, 0 in a request");
    visit("ts1", self.ts1, "ns", "companion clock, echoed");
  }
};

/// What the outputs are driven with, every eighth IMU sample.
struct RosflightOutputRaw {
  static constexpr std::uint8_t kId = 190;
  static constexpr const char* kName = "ROSFLIGHT_OUTPUT_RAW";

  std::uint64_t stamp{};
  std::array<float, 14> values{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ms", "FCU clock");
    visit("values", self.values, "1", "motors 0..1, servos 0..1 with 0.5 in the centre");
  }
};

/// State of the FCU.
struct RosflightStatus {
  static constexpr std::uint8_t kId = 191;
  static constexpr const char* kName = "ROSFLIGHT_STATUS";

  std::uint16_t rc_override{};
  std::int16_t num_errors{};
  std::int16_t loop_time_us{};
  std::uint8_t armed{};
  std::uint8_t failsafe{};
  std::uint8_t offboard{};
  std::uint8_t error_code{};
  std::uint8_t control_mode{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("rc_override", self.rc_override, "1", "OverrideBit: which axes the pilot holds and why");
    visit("num_errors", self.num_errors, "1", "sensor read errors");
    visit("loop_time_us", self.loop_time_us, "us", "duration of the control pass");
    visit("armed", self.armed, "1", "motors may turn");
    visit("failsafe", self.failsafe, "1", "flies the failsafe command");
    visit("offboard", self.offboard, "1", "a command of the companion is active");
    visit("error_code", self.error_code, "1", "ErrorBit");
    visit("control_mode", self.control_mode, "1", "0 pass-through, 1 rates, 2 angles");
  }
};

/// Version text.
struct RosflightVersion {
  static constexpr std::uint8_t kId = 192;
  static constexpr const char* kName = "ROSFLIGHT_VERSION";

  std::array<char, 50> version{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("version", self.version, "", "zero padded");
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
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("error_code", self.error_code, "1", "bits at the crash");
    visit("pc", self.pc, "1", "program counter");
    visit("reset_count", self.reset_count, "1", "resets so far");
    visit("doRearm", self.do_rearm, "1", "1 if it was armed");
  }
};

/// A line of log text.
struct Statustext {
  static constexpr std::uint8_t kId = 253;
  static constexpr const char* kName = "STATUSTEXT";

  std::uint8_t severity{};
  std::array<char, 50> text{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("severity", self.severity, "1", "0 emergency .. 7 debug");
    visit("text", self.text, "", "zero padded, at most 49 characters");
  }
};

}  // namespace ironbird::hil_bridge::rosflight
