#pragma once

#include "autopilot/estimator/ekf_state.hpp"
#include "autopilot/math/euler_zyx.hpp"

namespace ironbird::autopilot {

// The measurement models of the 12-state filter: h, C and R of each. ROScopter paper, measurement section;
// deviations in docs/equations.md. The barometer's h and C are BaroModel's.

/// GNSS: y = (n, e, v_N) with h = (p_n, p_e, R v). This is the lower part; the upper one picks two
/// components.
struct GnssVelocityModel {
  Vector3 h = Vector3::Zero();
  Eigen::Matrix<double, 3, 6> C = Eigen::Matrix<double, 3, 6>::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("h", self.h, "m/s", "predicted velocity in N");
  }
};

/// C belongs to the columns (v, Theta), which are neighbours: [R | d(R v)/dTheta].
GnssVelocityModel ekf_gnss_velocity(const EkfState& x, const EulerTrig& at);

/// Derivative of (p, v_N, Theta, b) with respect to the state: who has v_N instead of v_B.
EkfState::Matrix ekf_to_v_N(const EkfState& x, const EulerTrig& at);

/// The way back, derivative of the state with respect to (p, v_N, Theta, b).
EkfState::Matrix ekf_from_v_N(const EkfState& x, const EulerTrig& at);

/// A field this near to vertical (squared sine of the angle) has no azimuth; keeps the quotients finite.
inline constexpr double kLeastLevelness = 1.0e-9;

/// The tilt-compensated compass. The pseudo-measurement y(m, Theta) = declination - atan2(m1_y, m1_x) with
/// m1 = Ry(theta) Rx(phi) m depends on the state through the tilt, so the innovation y - psi has the Jacobian
/// -H with H = C - G, G = dy/dTheta, C = (0, 0, 1); and noise of m enters through F = dy/dm.
struct MagModel {
  double y = 0.0;
  Eigen::Matrix<double, 1, 3> F = Eigen::Matrix<double, 1, 3>::Zero();
  Eigen::Matrix<double, 1, 3> G = Eigen::Matrix<double, 1, 3>::Zero();
  double levelness = 0.0;

  /// Innovation Jacobian over Theta: C - G.
  Eigen::Matrix<double, 1, 3> H() const {
    Eigen::Matrix<double, 1, 3> C(0.0, 0.0, 1.0);
    return C - G;
  }
  /// Variance of y from the variances of each component of m and of what else is wrong with the heading.
  double R(double variance_m, double variance_tilt) const {
    return variance_m * F.squaredNorm() + variance_tilt;
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("y", self.y, "rad", "heading that the compass sees, (-pi, pi]");
    visit("levelness", self.levelness, "1", "horizontal part of the unit field, squared");
  }
};

/// The measured field turned about down by the innovation, so that it points where the state expects it. F, G
/// and H belong to this field: taken at the measured one, its noise would be in H and in the innovation
/// alike, and their correlation pulls the tilt (docs/equations.md, section 5).
/// @param down_B  unit vector down, in B
/// @param innovation  measured less predicted heading, rad
Vector3 expected_field(const Vector3& m_B, const Vector3& down_B, double innovation);

/// @param m_B  unit vector along the magnetic field
/// @param declination  rad
MagModel ekf_mag(const Vector3& m_B, const EulerTrig& at, double declination);

}  // namespace ironbird::autopilot
