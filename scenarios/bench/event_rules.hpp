#pragma once

#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// What is wrong with the scenario's events, as far as it can be known without flying: an event does exactly
/// one thing, has the keys that this thing needs and no others, and waits for something that can happen; so
/// do snapshots and the end of the run. What is asked of swaps and parameters the autopilot's loader checks.
/// Each finding begins with the path that it is about.
std::vector<std::string> event_findings(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
