#pragma once

#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// What is wrong with a scenario that a real unit is to fly: things that only a simulator can do. Each
/// finding begins with the path that it is about.
std::vector<std::string> live_findings(const LoadedScenario& loaded);

/// What of such a scenario is left to the pilot, for the operator to know.
std::vector<std::string> live_notes(const Scenario& scenario);

/// Why a check cannot be judged on a real vehicle, or empty when it can.
std::string why_not_judged(const CheckConfig& check);

}  // namespace ironbird::scenarios
