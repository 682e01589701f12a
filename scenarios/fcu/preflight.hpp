#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/interlock/interlock_state.hpp"
#include "scenarios/fcu/monitor_text.hpp"

namespace ironbird::scenarios {

/// How one thing stands before a flight.
enum class Light : std::uint8_t {
  kGreen,
  kRed,
  kUnlit  ///< nobody said what it should be
};

struct PreflightItem {
  std::string name;
  Light light = Light::kRed;
  std::string reason;  ///< why; for a red one what to do, too

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "what was looked at");
    visit("light", self.light, "1", "green, red, or unlit");
    visit("reason", self.reason, "", "why");
  }
};

/// What a unit is held to.
struct PreflightWishes {
  std::string scenario;                                                ///< its file; empty: none
  std::optional<std::vector<hil_bridge::ParameterRecord>> parameters;  ///< of that scenario
  double imu_rate = 400.0;                                             ///< Hz
};

/// Looks at a unit that has been listened to for more than two seconds. What the interlock looks at in flight
/// is judged by the interlock's words and limits; the rest is what only a preparation can see.
std::vector<PreflightItem> preflight(const Monitored& unit, const PreflightWishes& wishes);

/// What the interlock would be told of the unit.
hil_bridge::InterlockInputs interlock_inputs(const Monitored& unit, const PreflightWishes& wishes);

bool all_green(const std::vector<PreflightItem>& items);
std::string preflight_text(const std::vector<PreflightItem>& items, bool colour);
std::string preflight_json(const std::vector<PreflightItem>& items);

}  // namespace ironbird::scenarios
