#pragma once

#include <string>
#include <vector>

#include "scenarios/bench/autopilot_slots.hpp"
#include "scenarios/bench/scenario.hpp"

namespace ironbird::scenarios {

/// What is wrong with the events that swap modules and set parameters: a slot or kind that is not there, a
/// parameter that no module has which can be in the slot, a value outside its bounds. Each finding begins
/// with the path that it is about.
std::vector<std::string> module_findings(const Scenario& scenario, const std::vector<SlotAccess>& slots);

}  // namespace ironbird::scenarios
