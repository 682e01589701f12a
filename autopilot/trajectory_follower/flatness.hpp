#pragma once

#include "autopilot/types/control_setpoint.hpp"

namespace ironbird::autopilot {

/// What a specific force may be, for limit_specific_force.
struct ForceLimits {
  double min_lift = 1.0;       ///< m/s^2, > 0: least upward part
  double tan_max_tilt = 1.0;   ///< tangent of the greatest tilt, > 0
  double min_magnitude = 0.0;  ///< m/s^2, >= 0
  double max_magnitude = 1e9;  ///< m/s^2, > min_magnitude

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("min_lift", self.min_lift, "m/s^2", "least upward part");
    visit("tan_max_tilt", self.tan_max_tilt, "1", "tangent of the greatest tilt");
    visit("min_magnitude", self.min_magnitude, "m/s^2", "least magnitude");
    visit("max_magnitude", self.max_magnitude, "m/s^2", "greatest magnitude");
  }
};

/// The nearest allowed specific force: the lift first, then the tilt, then the magnitude. A force that is too
/// great loses horizontal part before it loses lift; one that is too small grows as a whole, so that its
/// direction stays.
/// @param u_N  acceleration wanted minus gravity, m/s^2
Vector3 limit_specific_force(const Vector3& u_N, const ForceLimits& limits);

/// Attitude, yaw rate and thrust that make the specific force `u_N` while the heading turns. ROScopter paper,
/// trajectory follower, differential flatness.
/// @param u_N      specific force, m/s^2; its z is negative
/// @param heading  of the vehicle, rad
/// @param turning  heading rate wanted, rad/s
/// @param mass     kg
AngleHeadingRateThrust flat_inverse(const Vector3& u_N, double heading, double turning, double mass);

/// The specific force in N that such a setpoint makes, m/s^2: the inverse of flat_inverse.
Vector3 specific_force(const AngleHeadingRateThrust& setpoint, double heading, double mass);

}  // namespace ironbird::autopilot
