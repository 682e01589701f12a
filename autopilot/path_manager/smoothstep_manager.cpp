#include "autopilot/path_manager/smoothstep_manager.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/math/smoothstep.hpp"

namespace ironbird::autopilot {

void SmoothstepManager::on_parameters() {
  Rules rules;
  rules.limits = params();
  rules.waypoint_tolerance = params().waypoint_tolerance;
  rules.switch_early = params().switch_early;
  rules.never_waits = params().reference_first_leg;
  set_rules(rules);
}

std::uint32_t SmoothstepManager::depart(const Departure& departure, const Route& route, std::uint32_t first) {
  const Waypoint& to = route.waypoints[first];
  const bool from_origin = params().reference_first_leg && departure.first;
  start_N_ = from_origin ? Vector3::Zero() : departure.p_N;
  start_heading_ = from_origin ? 0.0 : departure.heading;
  way_N_ = to.p_N - start_N_;
  turn_ = shortest_difference(to.heading, start_heading_);
  const double speed = to.speed > 0.0 ? to.speed : params().max_velocity;
  const double distance = (to.p_N - departure.p_N).norm();
  duration_ = leg_duration(distance, std::abs(turn_), speed, params());
  return first;
}

MotionPoint SmoothstepManager::evaluate(double elapsed) const {
  const bool instant = duration_ <= 0.0;
  const Smoothstep s = smoothstep(instant ? 1.0 : elapsed / duration_);
  const double per_second = instant ? 0.0 : 1.0 / duration_;
  const double first = s.first * per_second;
  const double second = s.second * per_second * per_second;
  MotionPoint point;
  point.p_N = start_N_ + s.value * way_N_;
  point.v_N = first * way_N_;
  point.a_N = second * way_N_;
  point.heading = wrap(start_heading_ + s.value * turn_);
  point.heading_rate = first * turn_;
  point.heading_acceleration = second * turn_;
  point.ended = elapsed >= duration_;
  return point;
}

}  // namespace ironbird::autopilot
