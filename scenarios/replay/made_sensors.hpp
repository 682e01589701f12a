#pragma once

#include <string>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "scenarios/replay/column_map.hpp"
#include "scenarios/replay/recorded_flight.hpp"
#include "simulator/sensors/sensor_site.hpp"

namespace ironbird::scenarios {

/// Messages of sensors that were not there, and a line for each that says with what errors it was made.
struct MadeMessages {
  std::vector<hil_bridge::Arrival> messages;  ///< by sensor
  std::vector<std::string> names;             ///< of the sensors
  std::vector<std::string> remarks;
};

/// Makes sensors from a truth, with the simulator's models of them: the same bytes for the same seed. A
/// sensor samples at every multiple of its period at which the truth says what it measures. Truth has no
/// rotors, no wind and no currents: the errors that models draw from these are nought.
/// @param wanted  its receiver's antenna is where the truth is (`p_BA_B` zero)
/// @param truth  its origin is that of `site`
/// @param end    no message arrives later
MadeMessages make_sensors(const MadeSensors& wanted, const RecordedEstimate& truth,
                          const simulator::SensorSite& site, hil_bridge::Time end);

}  // namespace ironbird::scenarios
