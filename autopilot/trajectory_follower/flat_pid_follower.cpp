#include "autopilot/trajectory_follower/flat_pid_follower.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/handover.hpp"
#include "autopilot/math/angles.hpp"
#include "autopilot/trajectory_follower/flatness.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kSmallestPitchCosine = 0.1;  // of the pitch, in the heading rate: about 84 degrees

/// Heading rate of the estimate, rad/s: (w_y sin(roll) + w_z cos(roll)) / cos(pitch), with the last row of
/// R_NB for the products of angles.
double turning(const StateEstimate& estimate) {
  const Quaternion& q = estimate.q_NB;
  const double sin_roll_cos_pitch = 2.0 * (q.y() * q.z() + q.w() * q.x());
  const double cos_roll_cos_pitch = 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
  const double cos_pitch_squared =
      sin_roll_cos_pitch * sin_roll_cos_pitch + cos_roll_cos_pitch * cos_roll_cos_pitch;
  return (estimate.w_NB_B.y() * sin_roll_cos_pitch + estimate.w_NB_B.z() * cos_roll_cos_pitch) /
         std::max(cos_pitch_squared, kSmallestPitchCosine * kSmallestPitchCosine);
}

}  // namespace

void FlatPidFollower::on_parameters() {
  const FlatPidFollowerParams& p = params();
  tan_max_tilt_ = std::tan(p.max_tilt);
  // What the vehicle cannot do must not be integrated: the loops know what tilt and thrust can give.
  const double sideways = p.gravity * tan_max_tilt_;
  const double upward = std::max(0.0, p.max_thrust / p.mass - p.gravity);
  const double downward = std::max(0.0, p.gravity - p.min_lift);
  north_.configure(p.north, p.derivative_time_constant, -sideways, sideways);
  east_.configure(p.east, p.derivative_time_constant, -sideways, sideways);
  down_.configure(p.down, p.derivative_time_constant, -upward, downward);
  heading_.configure(p.heading, p.derivative_time_constant, -p.max_heading_rate, p.max_heading_rate);
}

void FlatPidFollower::reset() {
  TrajectoryFollower::reset();
  for (Pid* pid : {&north_, &east_, &down_, &heading_}) pid->reset();
}

void FlatPidFollower::reset_integrals() {
  for (Pid* pid : {&north_, &east_, &down_, &heading_}) pid->reset_integral();
}

void FlatPidFollower::probe(ProbeVisitor& visit) const {
  visit("specific_force_N", specific_force_N_, "m/s^2");
  visit("integral", Vector3(north_.integral_part(), east_.integral_part(), down_.integral_part()), "m/s^2");
}

ControlSetpoint FlatPidFollower::track(const TrajectoryPoint& point, const StateEstimate& estimate,
                                       const FlightStatus& flight, double dt) {
  if (!point.valid || !is_usable(estimate.health)) return NoSetpoint{};
  if (flight.phase == FlightPhase::kDisarmed) reset_integrals();
  const FlatPidFollowerParams& p = params();
  const bool integrate = flight.companion_flies();
  const Vector3 a_N = acceleration(point, estimate, dt, integrate);
  const double turn = heading_rate(point, estimate, dt, integrate);
  const ForceLimits limits{p.min_lift, tan_max_tilt_, p.min_thrust / p.mass, p.max_thrust / p.mass};
  specific_force_N_ = limit_specific_force(a_N - Vector3(0.0, 0.0, p.gravity), limits);
  return flat_inverse(specific_force_N_, estimate.heading, turn, p.mass);
}

void FlatPidFollower::take_over(const Handover& left) {
  const auto* asked = std::get_if<AngleHeadingRateThrust>(&left.setpoint);
  const bool flew = left.flight.companion_flies() && left.trajectory.valid;
  if (asked == nullptr || !flew || !is_usable(left.estimate.health)) return;
  const StateEstimate& estimate = left.estimate;
  const TrajectoryPoint& point = left.trajectory;
  const Vector3 u_N = specific_force(*asked, estimate.heading, params().mass);
  const Vector3 by_loops_N = u_N + Vector3(0.0, 0.0, params().gravity) - fed_forward(point);
  const Vector3 error_N = position_error(point, estimate);
  const Vector3 rate_N = rate(point, estimate);
  north_.aim(error_N.x(), rate_N.x(), by_loops_N.x());
  east_.aim(error_N.y(), rate_N.y(), by_loops_N.y());
  down_.aim(error_N.z(), rate_N.z(), by_loops_N.z());
}

Vector3 FlatPidFollower::position_error(const TrajectoryPoint& point, const StateEstimate& estimate) const {
  Vector3 error_N = point.p_N - estimate.p_NB_N;
  error_N.z() = std::min(error_N.z(), params().down_command_window);
  return error_N;
}

Vector3 FlatPidFollower::rate(const TrajectoryPoint& point, const StateEstimate& estimate) const {
  const Vector3 v_NB_N = estimate.v_NB_N();
  return params().use_velocity_reference ? Vector3(v_NB_N - point.v_N) : v_NB_N;
}

Vector3 FlatPidFollower::fed_forward(const TrajectoryPoint& point) const {
  return point.a_N + params().drag * Vector3(point.v_N.x(), point.v_N.y(), 0.0);
}

Vector3 FlatPidFollower::acceleration(const TrajectoryPoint& point, const StateEstimate& estimate, double dt,
                                      bool integrate) {
  const Vector3 rate_N = rate(point, estimate);
  const Vector3 error_N = position_error(point, estimate);
  return fed_forward(point) + Vector3(north_.run(error_N.x(), rate_N.x(), dt, integrate),
                                      east_.run(error_N.y(), rate_N.y(), dt, integrate),
                                      down_.run(error_N.z(), rate_N.z(), dt, integrate));
}

double FlatPidFollower::heading_rate(const TrajectoryPoint& point, const StateEstimate& estimate, double dt,
                                     bool integrate) {
  const double error = shortest_difference(point.heading, estimate.heading);
  unwrapped_heading_ = unwrap_near(estimate.heading, unwrapped_heading_);
  const double correction = params().use_velocity_reference
                                ? heading_.run(error, turning(estimate) - point.heading_rate, dt, integrate)
                                : heading_.run_filtered(error, unwrapped_heading_, dt, integrate);
  return std::clamp(correction + point.heading_rate, -params().max_heading_rate, params().max_heading_rate);
}

}  // namespace ironbird::autopilot
