#pragma once

#include <string>
#include <vector>

#include "autopilot/signals.hpp"
#include "hil_bridge/hil_fcu/can_motors.hpp"
#include "hil_bridge/serial_fcu/link_statistics.hpp"
#include "hil_bridge/translate/telemetry.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// Lists everything that a check can name. The structs stay where they are as long as the table is used.
/// @param truth  null on a real vehicle: nothing of it is listed
/// @param rotors  of the vehicle: speeds and outputs of others are not listed
void add_signals(SignalTable& table, const simulator::Truth* truth, const autopilot::Signals& autopilot,
                 const hil_bridge::Telemetry& fcu, std::size_t rotors);

/// Lists what a check can name of the line to the unit and of the bus of its motors, as far as this scenario
/// has them.
void add_link_signals(SignalTable& table, const Scenario& scenario, const hil_bridge::LinkHealth& link,
                      const hil_bridge::CanMotorsStatus& can);

/// What is wrong with the scenario's checks: what no check could be made of, and events that can never
/// happen. Each finding begins with the path that it is about.
std::vector<std::string> check_findings(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
