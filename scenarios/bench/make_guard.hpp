#pragma once

#include <vector>

#include "hil_bridge/executive/guard.hpp"
#include "scenarios/bench/scenario.hpp"

namespace ironbird::scenarios {

/// What the vehicle's motors could give at most: full battery, air of sea level, every rotor at full speed.
/// A command beyond it is a mistake. Age: two control periods, and the delay that the scenario gives the way
/// down.
hil_bridge::CommandLimits command_limits(const Scenario& scenario);

/// The interlock as the scenario wants it.
hil_bridge::InterlockConfig interlock_config(const Scenario& scenario);

/// The parameters that a unit must have to be the scenario's: those that the scenario and the vehicle's files
/// name.
std::vector<hil_bridge::ParameterRecord> wanted_parameters(const Scenario& scenario);

/// Both override switches of the unit have a channel: the pilot can take over.
bool has_override_switches(const Scenario& scenario);

/// The value of an integer parameter of the scenario's unit. @param name  of one that there is
int unit_parameter(const Scenario& scenario, std::string_view name);

}  // namespace ironbird::scenarios
