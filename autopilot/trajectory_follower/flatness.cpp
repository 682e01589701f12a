#include "autopilot/trajectory_follower/flatness.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::autopilot {

Vector3 limit_specific_force(const Vector3& u_N, const ForceLimits& limits) {
  const double lift = std::clamp(-u_N.z(), limits.min_lift, std::max(limits.min_lift, limits.max_magnitude));
  const double room = std::max(limits.max_magnitude * limits.max_magnitude - lift * lift, 0.0);
  const double most = std::min(lift * limits.tan_max_tilt, std::sqrt(room));
  const double horizontal = std::sqrt(u_N.x() * u_N.x() + u_N.y() * u_N.y());
  const double share = horizontal > most ? most / horizontal : 1.0;
  const Vector3 allowed_N(share * u_N.x(), share * u_N.y(), -lift);
  const double magnitude = allowed_N.norm();
  return magnitude < limits.min_magnitude ? Vector3(limits.min_magnitude / magnitude * allowed_N) : allowed_N;
}

AngleHeadingRateThrust flat_inverse(const Vector3& u_N, double heading, double turning, double mass) {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double magnitude = u_N.norm();
  // The body's down axis opposes the specific force; here in V.
  const double z1 = -(c * u_N.x() + s * u_N.y()) / magnitude;
  const double z2 = -(c * u_N.y() - s * u_N.x()) / magnitude;
  const double z3 = -u_N.z() / magnitude;
  // While the heading turns, a force that is constant in N turns in V.
  const double z1_dot = z2 * turning;
  const double z13 = std::sqrt(z1 * z1 + z3 * z3);
  const double pitch_rate = z1_dot * z3 / (z13 * z13);
  const double sin_roll = std::clamp(-z2, -1.0, 1.0);
  const double cos_roll = z13;
  const double cos_pitch = z3 / z13;
  AngleHeadingRateThrust setpoint;
  setpoint.roll = std::asin(sin_roll);
  setpoint.pitch = std::atan2(z1, z3);
  setpoint.heading_rate = turning * cos_pitch * cos_roll - pitch_rate * sin_roll;
  setpoint.thrust = mass * magnitude;
  return setpoint;
}

Vector3 specific_force(const AngleHeadingRateThrust& setpoint, double heading, double mass) {
  const double cos_roll = std::cos(setpoint.roll);
  const double z1 = cos_roll * std::sin(setpoint.pitch);
  const double z2 = -std::sin(setpoint.roll);
  const double z3 = cos_roll * std::cos(setpoint.pitch);
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  return -setpoint.thrust / mass * Vector3(c * z1 - s * z2, s * z1 + c * z2, z3);
}

}  // namespace ironbird::autopilot
