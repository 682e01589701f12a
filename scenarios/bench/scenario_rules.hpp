#pragma once

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {

/// What a scenario must obey beyond the types and bounds of its single values: there is something to fly and
/// it lies above the ground, names of cameras exist, the field is there, events and checks make sense.
/// @return what is wrong, one line each, with its place
std::vector<std::string> rule_findings(const LoadedScenario& loaded);

/// The one setpoint that the table gives. @throws std::invalid_argument when there is none or more than one
autopilot::ControlSetpoint only_setpoint(const SetpointConfig& config);

/// The fault that an event with a `fault` begins.
simulator::Fault fault_of(const EventConfig& event);

/// The text of the event that says that a snapshot is due. It cannot be taken for an event of the flight.
std::string picture_event(const std::string& snapshot);

/// What an event does, for the log: its name, or a short text made from its deed.
std::string describe_event(const EventConfig& event);

}  // namespace ironbird::scenarios
