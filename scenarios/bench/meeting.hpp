#pragma once

#include <string>
#include <vector>

#include "hil_bridge/serial_fcu/serial_fcu.hpp"

namespace ironbird::scenarios {

/// What was heard instead of a unit that says who it is, and what to do.
/// @param patience  s, how long it was waited for
std::string why_not_met(const hil_bridge::SerialFcu& fcu, hil_bridge::Time now, double patience);

/// That the unit has other parameters than it must: the first few of them, and how to push all.
/// @param line  as a scenario names it
std::string text_about(const std::vector<hil_bridge::ParameterDifference>& differences,
                       const std::string& line);

}  // namespace ironbird::scenarios
