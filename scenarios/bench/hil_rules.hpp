#pragma once

#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// What is wrong with how the unit is wired: keys that mean nothing with this `fcu.kind`, motors that are not
/// to be had. @return without their places
std::vector<std::string> hil_findings(const LoadedScenario& loaded);

/// Commands of the autopilot that a unit on a desk cannot fly, because it feels no motion. Asked when the
/// autopilot's settings are known.
std::vector<std::string> loop_findings(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
