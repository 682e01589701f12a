#include "scenarios/bench/hil_rig.hpp"

namespace ironbird::scenarios {

std::unique_ptr<HilRig> make_hil_rig(const Scenario& scenario, simulator::World& world, bool faults) {
  return scenario.fcu.has_own_unit() ? make_own_unit_rig(scenario, world, faults)
                                     : make_line_rig(scenario, world, faults);
}

hil_bridge::can::EscBusParams played_escs(const Scenario& scenario) {
  hil_bridge::can::EscBusParams params;
  params.count = static_cast<int>(scenario.vehicle.rotors.size());
  params.fd = scenario.fcu.can_fd;
  return params;
}

}  // namespace ironbird::scenarios
