#pragma once

#include "autopilot/module/module.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Turns a setpoint at any of the twelve entry points into a command for the FCU, and owns the flight phase.
class Controller : public Module {
 public:
  /// One step. Non-finite commands are replaced by SilenceCommand and counted; a
  /// non-finite setpoint is taken as none.
  /// @param setpoint  what to fly in the offboard phase
  /// @param landing   the trajectory has come to a landing waypoint: begin the descent
  /// @return the command; valid until the next call
  const FcuCommand& run(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                        const FcuStatus& status);

  /// The phase after the last step.
  FlightPhase phase() const { return phase_; }

  /// The operator wants to take off: honoured when disarmed or on the ground, once armed.
  virtual void request_take_off() = 0;
  /// The operator wants to land here and now.
  virtual void request_landing() = 0;

  /// How often a command was not finite and was withheld.
  int withheld_commands() const { return withheld_commands_; }

  void reset() override;

  /// Starts in the phase that the predecessor was in.
  void take_over(const Signals& signals) override;

 protected:
  /// The work. Sets `phase` to the phase that it was in.
  /// @param dt  time since the previous call, s; 0 on the first
  virtual FcuCommand control(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                             const FcuStatus& status, double dt, FlightPhase& phase) = 0;

 private:
  FcuCommand last_ = SilenceCommand{};
  FlightPhase phase_ = FlightPhase::kDisarmed;
  Divider divider_;
  int withheld_commands_ = 0;
};

}  // namespace ironbird::autopilot
