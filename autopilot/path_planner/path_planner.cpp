#include "autopilot/path_planner/path_planner.hpp"

namespace ironbird::autopilot {

const Route& PathPlanner::run(const StateEstimate& estimate, const FlightStatus& flight) {
  double dt = 0.0;
  if (divider_.due(estimate.stamp, period(), dt) || last_ == nullptr) last_ = &plan(estimate, flight, dt);
  return *last_;
}

void PathPlanner::reset() {
  last_ = nullptr;
  divider_.reset();
}

}  // namespace ironbird::autopilot
