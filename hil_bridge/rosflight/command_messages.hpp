#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// What the companion wants, and the pilot. See messages.hpp.

namespace ironbird::hil_bridge::rosflight {

/// The pilot's sticks and switches.
struct RcChannels {
  static constexpr std::uint8_t kId = 65;
  static constexpr const char* kName = "RC_CHANNELS";

  std::uint32_t time_boot_ms{};
  std::array<std::uint16_t, 18> chan_raw{};
  std::uint8_t chancount{};
  std::uint8_t rssi{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("time_boot_ms", self.time_boot_ms, "ms", "receive time");
    constexpr std::array<const char*, 18> kNames = {
        "chan1_raw",  "chan2_raw",  "chan3_raw",  "chan4_raw",  "chan5_raw",  "chan6_raw",
        "chan7_raw",  "chan8_raw",  "chan9_raw",  "chan10_raw", "chan11_raw", "chan12_raw",
        "chan13_raw", "chan14_raw", "chan15_raw", "chan16_raw", "chan17_raw", "chan18_raw"};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      visit(kNames[k], self.chan_raw[k], "us", "pulse width; only the first eight are filled");
    }
    visit("chancount", self.chancount, "1", "always 0");
    visit("rssi", self.rssi, "1", "always 0");
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
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("u", self.u, "SI", "forces, torques or their setpoints, then free mixer inputs");
    visit("ignore", self.ignore, "1", "bit i: u[i] is not commanded");
    visit("mode", self.mode, "1", "0 pass-through, 1 rates, 2 angles");
  }
};

/// A command to the FCU's housekeeping.
struct RosflightCmd {
  static constexpr std::uint8_t kId = 188;
  static constexpr const char* kName = "ROSFLIGHT_CMD";

  std::uint8_t command{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
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
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("command", self.command, "1", "which");
    visit("success", self.success, "1", "0 failed, 1 accepted");
  }
};

/// Commands to auxiliary outputs.
struct RosflightAuxCmd {
  static constexpr std::uint8_t kId = 193;
  static constexpr const char* kName = "ROSFLIGHT_AUX_CMD";

  std::array<float, 14> aux_cmd_array{};
  std::array<std::uint8_t, 14> type_array{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
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
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("qw", self.qw, "1", "body to world");
    visit("qx", self.qx, "1", "body to world");
    visit("qy", self.qy, "1", "body to world");
    visit("qz", self.qz, "1", "body to world");
  }
};

}  // namespace ironbird::hil_bridge::rosflight
