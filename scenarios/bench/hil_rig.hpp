#pragma once

#include <memory>

#include "hil_bridge/hil_fcu/hil_fcu.hpp"
#include "hil_bridge/hil_fcu/stand_motors.hpp"
#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "hil_bridge/transport/bus_fault.hpp"
#include "hil_bridge/transport/link_fault.hpp"
#include "scenarios/bench/scenario.hpp"

namespace ironbird::scenarios {

/// What stands around a simulated vehicle that a unit on a desk flies: the unit or the line to it, the bus of
/// the motors, the played motor controllers.
class HilRig {
 public:
  virtual ~HilRig() = default;

  virtual hil_bridge::Fcu& fcu() = 0;
  virtual const hil_bridge::SerialFcu& serial() const = 0;
  /// Is asked before anything leaves; before it is set nothing but questions does. @param gate  outlives this
  virtual void set_gate(hil_bridge::Gate& gate) = 0;
  /// The simulated pilot; null: one of flesh and blood.
  virtual hil_bridge::RcPilot* pilot() = 0;
  /// Null: no such line or bus, or one that cannot fail.
  virtual hil_bridge::transport::LinkFault* line_faults() = 0;
  virtual hil_bridge::transport::BusFault* bus_faults() = 0;
  /// Null: OUTPUT_RAW turns the rotors.
  virtual hil_bridge::CanMotors* motors() = 0;
  /// From now on the real motors of the stand, if there is one, do what gate and unit let them.
  /// @param gate  outlives this
  virtual void open_stand(const hil_bridge::InterlockStatus& gate) = 0;
  /// Null: there is none, or it is not open yet.
  virtual hil_bridge::StandMotors* stand() = 0;
  /// Waits until it is time for the tick that ends at `now`. @return false when the bench stood still for so
  /// long that the unit is no longer its own: a stopped program that is continued must not go on as if
  /// nothing were
  virtual bool wait_for(hil_bridge::Time now) = 0;
  /// By how much the run fell behind a unit that does not wait.
  virtual hil_bridge::Time lost() const = 0;
};

/// The rig that the scenario asks for. With `fcu.line = "virtual"` the unit is a virtual one in this process,
/// reached over a pseudo-terminal in lock-step, its bus is in this process too, and two runs have the same
/// bytes. With any other line time passes as the clock of the wall lets it.
/// @param world   the simulated vehicle; outlives the rig
/// @param faults  the line and the bus are to be made such that they can fail
/// @throws std::invalid_argument naming key, value and bound, transport::LinkError for a line or an interface
/// that cannot be had
std::unique_ptr<HilRig> make_hil_rig(const Scenario& scenario, simulator::World& world, bool faults);

std::unique_ptr<HilRig> make_own_unit_rig(const Scenario& scenario, simulator::World& world, bool faults);
std::unique_ptr<HilRig> make_line_rig(const Scenario& scenario, simulator::World& world, bool faults);

/// The motor controllers that the bench plays.
hil_bridge::can::EscBusParams played_escs(const Scenario& scenario);

}  // namespace ironbird::scenarios
