#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// Reads `[autopilot]`: for each slot its `kind`, its `period` and parameters of the module in it; and under
/// `[autopilot.kinds.KIND]` parameters that hold whenever a module of that kind flies, also after a swap.
/// Units and bounds are those of the module's own parameters. Gravity, declination and inclination, where a
/// module has them, are the environment's unless given.
/// Holds the scenario's events that swap modules and set parameters against the modules there are.
/// @return what is wrong, one line each, with its place
std::vector<std::string> load_autopilot(const toml::table& root, const autopilot::Modules& modules,
                                        LoadedScenario& loaded);

}  // namespace ironbird::scenarios
