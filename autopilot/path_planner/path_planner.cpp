#include "autopilot/path_planner/path_planner.hpp"

#include "autopilot/handover.hpp"

namespace ironbird::autopilot {

const Route& PathPlanner::run(const StateEstimate& estimate, const FlightStatus& flight) {
  double dt = 0.0;
  if (divider_.due(estimate.stamp, period(), dt)) plan(estimate, flight, dt);
  return route();
}

void PathPlanner::reset() {
  divider_.reset();
}

void PathPlanner::hand_over(Handover& handover) const {
  handover.route = route();
  handover.wanted = wanted();
}

}  // namespace ironbird::autopilot
