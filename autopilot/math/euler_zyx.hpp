#pragma once

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

// ZYX Euler angles Theta = (roll, pitch, heading) = (phi, theta, psi) of B in N, rad, as one Vector3.
// Small Unmanned Aircraft, section 2.2 and 3.2; ROScopter paper, eq. 2.

/// Sines and cosines of the three angles, computed once and used by all functions below.
///
/// 1/cos(theta) is bounded by kMaxSecant, so that the kinematics stay finite at pitch +-90 degrees, where
/// they are singular.
struct EulerTrig {
  static constexpr double kMaxSecant = 1.0e3;

  double s_phi = 0.0;
  double c_phi = 1.0;
  double s_theta = 0.0;
  double c_theta = 1.0;
  double s_psi = 0.0;
  double c_psi = 1.0;
  double secant = 1.0;   ///< 1/cos(theta), bounded
  double tangent = 0.0;  ///< sin(theta)/cos(theta), bounded

  EulerTrig() = default;
  explicit EulerTrig(const Vector3& theta);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("s_phi", self.s_phi, "1", "sine of roll");
    visit("c_phi", self.c_phi, "1", "cosine of roll");
    visit("s_theta", self.s_theta, "1", "sine of pitch");
    visit("c_theta", self.c_theta, "1", "cosine of pitch");
    visit("s_psi", self.s_psi, "1", "sine of heading");
    visit("c_psi", self.c_psi, "1", "cosine of heading");
    visit("secant", self.secant, "1", "1/cos(pitch), bounded");
    visit("tangent", self.tangent, "1", "tan(pitch), bounded");
  }
};

/// R(Theta): takes B components to N.
Matrix3 rotation_NB(const EulerTrig& at);

/// S(Theta): Theta_dot = S w_NB_B.
Matrix3 euler_rate_matrix(const EulerTrig& at);

/// The inverse of S: w_NB_B = S^-1 Theta_dot. Finite everywhere.
Matrix3 body_rate_matrix(const EulerTrig& at);

/// d(R v)/dTheta for a fixed v in B; column j is the derivative with respect to angle j.
Matrix3 rotated_vector_jacobian(const EulerTrig& at, const Vector3& v_B);

/// d(R^T e_d)/dTheta, where e_d is down in N: how the direction of gravity in B turns with the angles.
Matrix3 down_in_body_jacobian(const EulerTrig& at);

/// d(S w)/dTheta for a fixed w in B.
Matrix3 euler_rate_jacobian(const EulerTrig& at, const Vector3& w_B);

/// q_NB of Theta. Hamilton, w >= 0 not enforced.
Quaternion quaternion_NB(const Vector3& theta);

/// Theta of q_NB (unit): roll and heading in (-pi, pi], pitch in [-pi/2, pi/2]. At pitch +-90 degrees, where
/// only heading -+ roll is defined, the roll that atan2 finds is kept and the heading follows.
Vector3 euler_from_quaternion(const Quaternion& q_NB);

/// The equivalent angles with pitch in [-pi/2, pi/2] and the others in (-pi, pi].
/// @param flipped  set to true when pitch had passed +-90 degrees, so that the sign of its error turned over
Vector3 canonical_euler(const Vector3& theta, bool& flipped);

/// [a]x: the matrix with [a]x b = a x b.
Matrix3 skew(const Vector3& a);

}  // namespace ironbird::autopilot
