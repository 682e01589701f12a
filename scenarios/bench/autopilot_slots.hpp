#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"

namespace ironbird::scenarios {

/// One slot of the autopilot: its name, its place in the configuration, and how to see the parameters of a
/// kind.
struct SlotAccess {
  std::string name;
  autopilot::AutopilotConfig::Slot* slot;
  std::function<std::vector<std::string>()> kinds;
  /// Registers the parameters of a new module of `kind` under the slot's name. The module lives as long as
  /// the return value.
  std::function<std::shared_ptr<void>(const std::string& kind, autopilot::ParameterTable&)> make;
};

/// @param config, modules  outlive the return value
std::vector<SlotAccess> all_slots(autopilot::AutopilotConfig& config, const autopilot::Modules& modules);

/// `a, b, c`
std::string joined(const std::vector<std::string>& names);

}  // namespace ironbird::scenarios
