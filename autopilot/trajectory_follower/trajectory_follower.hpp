#pragma once

#include "autopilot/module/module.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "autopilot/types/trajectory_point.hpp"

namespace ironbird::autopilot {

/// Turns a trajectory point into a setpoint of the controller.
class TrajectoryFollower : public Module {
 public:
  /// One step. @return the setpoint, NoSetpoint when there is nothing valid to fly; valid until the next call
  const ControlSetpoint& run(const TrajectoryPoint& point, const StateEstimate& estimate,
                             const FlightStatus& flight);

  void reset() override;

 protected:
  /// The work. Integrators stand still while `flight.companion_flies()` is false.
  /// @param dt  time since the previous call, s; 0 on the first
  virtual ControlSetpoint track(const TrajectoryPoint& point, const StateEstimate& estimate,
                                const FlightStatus& flight, double dt) = 0;

 private:
  ControlSetpoint last_ = NoSetpoint{};
  Divider divider_;
};

}  // namespace ironbird::autopilot
