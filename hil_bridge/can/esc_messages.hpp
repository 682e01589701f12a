#pragma once

#include <cstdint>

#include "hil_bridge/can/serialisation.hpp"

// Motors: commands to their controllers (ESC) and what those report. See dronecan_messages.hpp.

namespace ironbird::hil_bridge::can {

inline constexpr int kGreatestRawCommand = 8191;

/// How strongly each motor is to turn. The place in the list is the number of the ESC.
struct RawCommand {
  static constexpr DataType kType = {
      "uavcan.equipment.esc.RawCommand", {1030, TransferKind::kMessage}, 0x217F5C87D7EC951D};

  BoundedList<std::int16_t, 20> cmd{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("cmd", self.cmd, "1", "8191 all forward, 0 stop, -8192 all backward", Bits{14});
  }
};

/// How fast each motor is to turn.
struct RpmCommand {
  static constexpr DataType kType = {
      "uavcan.equipment.esc.RPMCommand", {1031, TransferKind::kMessage}, 0xCE0F9F621CF7E70B};

  BoundedList<std::int32_t, 20> rpm{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("rpm", self.rpm, "rpm", "speed wanted, negative backward", Bits{18});
  }
};

/// What one ESC measures. What it does not know is NaN.
struct EscStatus {
  static constexpr DataType kType = {
      "uavcan.equipment.esc.Status", {1034, TransferKind::kMessage}, 0xA9AF28AEA2FBB254};

  std::uint32_t error_count{};
  float voltage{};
  float current{};
  float temperature{};
  std::int32_t rpm{};
  std::uint8_t power_rating_pct{};
  std::uint8_t esc_index{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("error_count", self.error_count, "1", "since it started");
    visit("voltage", self.voltage, "V", "of the supply", Half{});
    visit("current", self.current, "A", "negative while braking into the supply", Half{});
    visit("temperature", self.temperature, "K", "of the ESC", Half{});
    visit("rpm", self.rpm, "rpm", "negative backward", Bits{18});
    visit("power_rating_pct", self.power_rating_pct, "%", "demand, of the greatest power", Bits{7});
    visit("esc_index", self.esc_index, "1", "place in the command", Bits{5});
  }
};

/// More of the same.
struct EscStatusExtended {
  static constexpr DataType kType = {
      "uavcan.equipment.esc.StatusExtended", {1036, TransferKind::kMessage}, 0x02DC203C50960EDC};

  std::uint8_t input_pct{};
  std::uint8_t output_pct{};
  std::int16_t motor_temperature_degC{};
  std::uint16_t motor_angle{};
  std::uint32_t status_flags{};
  std::uint8_t esc_index{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("input_pct", self.input_pct, "%", "command", Bits{7});
    visit("output_pct", self.output_pct, "%", "given to the motor", Bits{7});
    visit("motor_temperature_degC", self.motor_temperature_degC, "degC", "of the motor", Bits{9});
    visit("motor_angle", self.motor_angle, "deg", "of the motor's shaft", Bits{9});
    visit("status_flags", self.status_flags, "1", "the maker's", Bits{19});
    visit("esc_index", self.esc_index, "1", "place in the command", Bits{5});
  }
};

/// Whether motors may turn.
struct ArmingStatus {
  static constexpr DataType kType = {
      "uavcan.equipment.safety.ArmingStatus", {1100, TransferKind::kMessage}, 0x8700F375556A8003};
  static constexpr std::uint8_t kDisarmed = 0;
  static constexpr std::uint8_t kArmed = 255;

  std::uint8_t status{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("status", self.status, "1", "0 disarmed, 255 armed");
  }
};

}  // namespace ironbird::hil_bridge::can
