#pragma once

#include "autopilot/module/module.hpp"
#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "autopilot/types/trajectory_point.hpp"

namespace ironbird::autopilot {

/// Turns the route into a point that moves along it, with derivatives.
class PathManager : public Module {
 public:
  /// One step. @return where the vehicle should be now; valid until the next call
  const TrajectoryPoint& run(const Route& route, const StateEstimate& estimate, const FlightStatus& flight);

  void reset() override;

 protected:
  /// The work. The clock of the trajectory stands still while `flight.companion_flies()` is false.
  /// @param dt  time since the previous call, s; 0 on the first
  virtual TrajectoryPoint follow(const Route& route, const StateEstimate& estimate,
                                 const FlightStatus& flight, double dt) = 0;

 private:
  TrajectoryPoint last_;
  Divider divider_;
};

}  // namespace ironbird::autopilot
