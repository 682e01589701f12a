#pragma once

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// Does the vehicle's folder hold a scene, and does the scenario name a field? Without them it can be flown
/// but not drawn.
bool has_scene(const LoadedScenario& loaded);

/// Finds out before the flight, not after it, that it cannot be drawn.
/// @throws ConfigError naming the file that is missing or wrong
void check_scene(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
