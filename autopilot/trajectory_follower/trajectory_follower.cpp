#include "autopilot/trajectory_follower/trajectory_follower.hpp"

#include "autopilot/math/finite.hpp"

namespace ironbird::autopilot {

const ControlSetpoint& TrajectoryFollower::run(const TrajectoryPoint& point, const StateEstimate& estimate,
                                               const FlightStatus& flight) {
  double dt = 0.0;
  if (!divider_.due(estimate.stamp, period(), dt)) return last_;
  last_ = track(point, estimate, flight, dt);
  if (!all_finite(last_)) last_ = NoSetpoint{};
  return last_;
}

void TrajectoryFollower::reset() {
  last_ = NoSetpoint{};
  divider_.reset();
}

}  // namespace ironbird::autopilot
