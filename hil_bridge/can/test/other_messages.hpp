#pragma once

#include "hil_bridge/can/serialisation.hpp"

// Messages that no part of the bench needs, described here to try the descriptions on.

namespace ironbird::hil_bridge::can {

struct ActuatorStatus {
  static constexpr DataType kType = {
      "uavcan.equipment.actuator.Status", {1011, TransferKind::kMessage}, 0x5E9BBA44FAF1EA04};

  std::uint8_t actuator_id{};
  float position{};
  float force{};
  float speed{};
  std::uint8_t power_rating_pct{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("actuator_id", self.actuator_id, "1", "which");
    visit("position", self.position, "SI", "m or rad", Half{});
    visit("force", self.force, "SI", "N or N m", Half{});
    visit("speed", self.speed, "SI", "m/s or rad/s", Half{});
    // Seven bits after an empty one are as good as eight.
    visit("power_rating_pct", self.power_rating_pct, "%", "127 unknown");
  }
};

struct LogMessage {
  static constexpr DataType kType = {
      "uavcan.protocol.debug.LogMessage", {16383, TransferKind::kMessage}, 0xD654A48E0C049D75};

  std::uint8_t level{};
  BoundedText<31> source{};
  BoundedText<90> text{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("level", self.level, "1", "0 debug to 3 error", Bits{3});
    visit("source", self.source, "", "who");
    visit("text", self.text, "", "what");
  }
};

struct BatteryInfo {
  static constexpr DataType kType = {
      "uavcan.equipment.power.BatteryInfo", {1092, TransferKind::kMessage}, 0x249C26548A711966};

  float temperature{};
  float voltage{};
  float current{};
  float average_power_10sec{};
  float remaining_capacity_wh{};
  float full_charge_capacity_wh{};
  float hours_to_full_charge{};
  std::uint16_t status_flags{};
  std::uint8_t state_of_health_pct{};
  std::uint8_t state_of_charge_pct{};
  std::uint8_t state_of_charge_pct_stdev{};
  std::uint8_t battery_id{};
  std::uint32_t model_instance_id{};
  BoundedText<31> model_name{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("temperature", self.temperature, "K", "of the cells", Half{});
    visit("voltage", self.voltage, "V", "of the pack", Half{});
    visit("current", self.current, "A", "drawn", Half{});
    visit("average_power_10sec", self.average_power_10sec, "W", "drawn", Half{});
    visit("remaining_capacity_wh", self.remaining_capacity_wh, "W*h", "left", Half{});
    visit("full_charge_capacity_wh", self.full_charge_capacity_wh, "W*h", "full", Half{});
    visit("hours_to_full_charge", self.hours_to_full_charge, "h", "to wait", Half{});
    visit("status_flags", self.status_flags, "1", "bits", Bits{11});
    visit("state_of_health_pct", self.state_of_health_pct, "%", "age", Bits{7});
    visit("state_of_charge_pct", self.state_of_charge_pct, "%", "left", Bits{7});
    visit("state_of_charge_pct_stdev", self.state_of_charge_pct_stdev, "%", "how sure", Bits{7});
    visit("battery_id", self.battery_id, "1", "which");
    visit("model_instance_id", self.model_instance_id, "1", "which one of its kind");
    visit("model_name", self.model_name, "", "kind");
  }
};

}  // namespace ironbird::hil_bridge::can
