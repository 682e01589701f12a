#include "autopilot/estimator/ekf_measurements.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

GnssVelocityModel ekf_gnss_velocity(const EkfState& x, const EulerTrig& at) {
  const Matrix3 R_NB = rotation_NB(at);
  GnssVelocityModel model;
  model.h = R_NB * x.v_NB_B;
  model.C.leftCols<3>() = R_NB;
  model.C.rightCols<3>() = rotated_vector_jacobian(at, x.v_NB_B);
  return model;
}

EkfState::Matrix ekf_to_v_N(const EkfState& x, const EulerTrig& at) {
  EkfState::Matrix T = EkfState::Matrix::Identity();
  T.middleRows<3>(EkfState::kVelocity).middleCols<6>(EkfState::kVelocity) = ekf_gnss_velocity(x, at).C;
  return T;
}

EkfState::Matrix ekf_from_v_N(const EkfState& x, const EulerTrig& at) {
  // v_B = R^T v_N, and R dv_B + d(R v_B)/dTheta dTheta = dv_N.
  EkfState::Matrix T = EkfState::Matrix::Identity();
  const Matrix3 R_BN = rotation_NB(at).transpose();
  T.block<3, 3>(EkfState::kVelocity, EkfState::kVelocity) = R_BN;
  T.block<3, 3>(EkfState::kVelocity, EkfState::kAttitude) = -R_BN * ekf_gnss_velocity(x, at).C.rightCols<3>();
  return T;
}

Vector3 expected_field(const Vector3& m_B, const Vector3& down_B, double innovation) {
  const double cosine = std::cos(innovation);
  return cosine * m_B + std::sin(innovation) * down_B.cross(m_B) +
         ((1.0 - cosine) * down_B.dot(m_B)) * down_B;
}

MagModel ekf_mag(const Vector3& m_B, const EulerTrig& at, double declination) {
  // m1 = Ry(theta) Rx(phi) m, its horizontal part.
  const double z_rolled = at.s_phi * m_B.y() + at.c_phi * m_B.z();
  const double m1_x = at.c_theta * m_B.x() + at.s_theta * z_rolled;
  const double m1_y = at.c_phi * m_B.y() - at.s_phi * m_B.z();
  MagModel model;
  model.levelness = m1_x * m1_x + m1_y * m1_y;
  model.y = wrap(declination - std::atan2(m1_y, m1_x));
  // dy = (m1_y dm1_x - m1_x dm1_y) / (m1_x^2 + m1_y^2)
  const double along_x = m1_y / std::max(model.levelness, kLeastLevelness);
  const double along_y = -m1_x / std::max(model.levelness, kLeastLevelness);
  model.F << along_x * at.c_theta, along_x * at.s_theta * at.s_phi + along_y * at.c_phi,
      along_x * at.s_theta * at.c_phi - along_y * at.s_phi;
  // d m1_x/dphi = s_theta m1_y, d m1_y/dphi = -z_rolled; d m1_x/dtheta = -s_theta m_x + c_theta z_rolled.
  model.G << along_x * at.s_theta * m1_y - along_y * z_rolled,
      along_x * (-at.s_theta * m_B.x() + at.c_theta * z_rolled), 0.0;
  return model;
}

}  // namespace ironbird::autopilot
