#pragma once

#include <toml++/toml.h>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// Reads `[autopilot]`: for each slot its `kind`, its `period` and parameters of the module in it; and under
/// `[autopilot.kinds.KIND]` parameters that hold whenever a module of that kind flies, also after a swap.
/// Units and bounds are those of the module's own parameters. Gravity, declination and inclination, where a
/// module has them, are the environment's unless given.
/// @throws ConfigError with one line for each finding
void load_autopilot(const toml::table& root, const autopilot::Modules& modules, LoadedScenario& loaded);

}  // namespace ironbird::scenarios
