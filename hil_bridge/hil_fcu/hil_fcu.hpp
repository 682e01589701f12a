#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/hil_fcu/can_motors.hpp"
#include "hil_bridge/virtual_fcu/firmware_host.hpp"
#include "simulator/world.hpp"

namespace ironbird::hil_bridge {

/// Hardware in the loop: a real unit, on a desk, flies a simulated vehicle.
///
/// The unit's outputs turn the simulated rotors, either as OUTPUT_RAW tells them, 50 times a second, or as
/// its commands to motor controllers on a CAN bus. The simulated sensors answer: inertial unit, magnetometer,
/// barometer, satellites, range and airspeed come from the simulation, through the sensor half of the
/// firmware's equivalent, so in the unit's words, at its rates, with its calibration. What the unit itself
/// says of these is not passed on; all else is: status, radio, attitude, outputs, battery, texts, parameters.
///
/// A unit on a desk feels no motion, so its own angle and rate loops cannot close. In pass-through, all loops
/// on the companion, it needs to feel none.
class HilFcu final : public Fcu {
 public:
  /// A unit that has not told its outputs for so long is taken for one without power: the rotors stop.
  static constexpr Time kOutputSilence = std::chrono::milliseconds(500);

  /// @param config  of the simulated sensors: tick, parameters
  /// @param world   the simulated vehicle, stepped by nobody else; outlives this
  /// @param unit    as it is reached, its time let pass by nobody else; outlives this
  /// @param motors  on a bus; null: OUTPUT_RAW turns the rotors; outlives this
  /// @param external_attitude  how often the unit is told the simulated attitude, Hz; 0: never
  /// @throws std::invalid_argument naming key, value and bound
  HilFcu(const VirtualFcuConfig& config, simulator::World& world, Fcu& unit, CanMotors* motors = nullptr,
         double external_attitude = 0.0);

  /// Steps world, sensors and unit tick by tick as far as `now` allows.
  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override;
  void send(const rosflight::Message& message) override { unit_.send(message); }

  /// What the rotors were told in the last tick.
  const simulator::RotorCommands& commands() const { return commands_; }

 private:
  void tick(Time next);
  void send_attitude(Time now);
  void take_from_unit(Time now);
  void take_from_sensors();
  simulator::RotorCommands told_outputs(Time now) const;

  simulator::World& world_;
  Fcu& unit_;
  CanMotors* motors_;
  FirmwareHost sensors_;
  Time period_;
  Time attitude_period_;  // zero: never
  Time next_attitude_{};
  Time now_{};
  simulator::RotorCommands commands_;
  simulator::RotorCommands outputs_;
  std::optional<Time> told_;
  bool armed_ = false;
  std::vector<Arrival> arrivals_;
  std::vector<Arrival> inbox_;
};

}  // namespace ironbird::hil_bridge
