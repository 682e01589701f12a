#include "autopilot/path_manager/path_manager.hpp"

#include "autopilot/math/finite.hpp"

namespace ironbird::autopilot {

const TrajectoryPoint& PathManager::run(const Route& route, const StateEstimate& estimate,
                                        const FlightStatus& flight) {
  double dt = 0.0;
  if (!divider_.due(estimate.stamp, period(), dt)) return last_;
  const TrajectoryPoint point = follow(route, estimate, flight, dt);
  if (all_finite(point)) last_ = point;
  return last_;
}

void PathManager::reset() {
  last_ = TrajectoryPoint{};
  divider_.reset();
}

}  // namespace ironbird::autopilot
