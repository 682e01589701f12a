#include "autopilot/controller/descent.hpp"

#include <algorithm>

#include "autopilot/controller/cascade.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kPatience = 2.0;  // s, for what drives it on; the ground is better than an endless brake

double horizontal_speed(const StateEstimate& estimate) {
  return estimate.v_NB_N().head<2>().norm();
}

}  // namespace

double Descent::sink(const StateEstimate& estimate, double wanted, double dt, double deceleration,
                     double catching) {
  if (!v_down_) begin(estimate, deceleration);
  const bool moves = estimate.position_known && horizontal_speed(estimate) > kSlow;
  brakes_ = brakes_ && moves && estimate.stamp < brake_ends_;
  const double change = (brakes_ ? 0.0 : wanted) - *v_down_;
  *v_down_ += std::clamp(change, -catching * dt, deceleration * dt);
  return *v_down_;
}

void Descent::begin(const StateEstimate& estimate, double deceleration) {
  v_down_ = std::max(0.0, estimate.v_NB_N().z());
  brakes_ = estimate.position_known;
  if (!brakes_) return;
  const double longest = 2.0 * horizontal_speed(estimate) / deceleration + kPatience;  // s
  brake_ends_ = estimate.stamp + Time{static_cast<Time::rep>(1e9 * longest)};
}

}  // namespace ironbird::autopilot
