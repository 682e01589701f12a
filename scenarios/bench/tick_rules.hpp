#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// A period as messages show it: `2.5 ms`.
std::string in_milliseconds(std::chrono::nanoseconds time);

/// Is the tick the scenario's choice, or the command line's, and `path`, which it must suit, the vehicle's?
/// Then the tick is what is wrong when the two do not go together.
bool tick_is_to_blame(const LoadedScenario& loaded, const std::string& path);

/// A tick of the scenario's choice that does not divide the periods of the vehicle's sensors, its radio or
/// the latencies of its line: one finding that names them and a tick that would do. What does not suit a tick
/// that is not to blame is found when the objects of the run are made. @return without its place, or nothing
std::vector<std::string> tick_findings(const LoadedScenario& loaded);

/// Periods of the log and latencies that are not a whole number of ticks: each with the nearest that are.
std::vector<std::string> whole_tick_findings(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
