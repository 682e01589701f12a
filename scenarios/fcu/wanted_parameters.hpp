#pragma once

#include <vector>

#include "hil_bridge/serial_fcu/parameter_set.hpp"
#include "scenarios/bench/scenario.hpp"

namespace ironbird::scenarios {

/// The parameters that a unit must have to be the scenario's: those that the scenario and the vehicle's files
/// name.
std::vector<hil_bridge::ParameterRecord> wanted_parameters(const Scenario& scenario);

}  // namespace ironbird::scenarios
