#include "autopilot/math/euler_zyx.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

EulerTrig::EulerTrig(const Vector3& theta)
    : s_phi(std::sin(theta.x())),
      c_phi(std::cos(theta.x())),
      s_theta(std::sin(theta.y())),
      c_theta(std::cos(theta.y())),
      s_psi(std::sin(theta.z())),
      c_psi(std::cos(theta.z())) {
  const double divisor = std::copysign(std::max(std::abs(c_theta), 1.0 / kMaxSecant), c_theta);
  secant = 1.0 / divisor;
  tangent = s_theta * secant;
}

Matrix3 rotation_NB(const EulerTrig& at) {
  const double sphi_stheta = at.s_phi * at.s_theta;
  const double cphi_stheta = at.c_phi * at.s_theta;
  Matrix3 R;
  R << at.c_theta * at.c_psi, sphi_stheta * at.c_psi - at.c_phi * at.s_psi,
      cphi_stheta * at.c_psi + at.s_phi * at.s_psi,  //
      at.c_theta * at.s_psi, sphi_stheta * at.s_psi + at.c_phi * at.c_psi,
      cphi_stheta * at.s_psi - at.s_phi * at.c_psi,  //
      -at.s_theta, at.s_phi * at.c_theta, at.c_phi * at.c_theta;
  return R;
}

Matrix3 euler_rate_matrix(const EulerTrig& at) {
  Matrix3 S;
  S << 1.0, at.s_phi * at.tangent, at.c_phi * at.tangent,  //
      0.0, at.c_phi, -at.s_phi,                            //
      0.0, at.s_phi * at.secant, at.c_phi * at.secant;
  return S;
}

Matrix3 body_rate_matrix(const EulerTrig& at) {
  Matrix3 S_inverse;
  S_inverse << 1.0, 0.0, -at.s_theta,        //
      0.0, at.c_phi, at.s_phi * at.c_theta,  //
      0.0, -at.s_phi, at.c_phi * at.c_theta;
  return S_inverse;
}

Matrix3 rotated_vector_jacobian(const EulerTrig& at, const Vector3& v_B) {
  // R v = Rz(psi) Ry(theta) Rx(phi) v: roll first, then pitch, then heading.
  const double y_rolled = at.c_phi * v_B.y() - at.s_phi * v_B.z();
  const double z_rolled = at.s_phi * v_B.y() + at.c_phi * v_B.z();
  const double x_level = at.c_theta * v_B.x() + at.s_theta * z_rolled;
  const double z_level = -at.s_theta * v_B.x() + at.c_theta * z_rolled;
  // d/dphi: (y, z) rolled -> (-z, y), then through Ry and Rz.
  const double d_phi_x = at.s_theta * y_rolled;
  const double d_phi_y = -z_rolled;
  Matrix3 J;
  J << at.c_psi * d_phi_x - at.s_psi * d_phi_y, at.c_psi * z_level, -at.s_psi * x_level - at.c_psi * y_rolled,
      at.s_psi * d_phi_x + at.c_psi * d_phi_y, at.s_psi * z_level, at.c_psi * x_level - at.s_psi * y_rolled,
      at.c_theta * y_rolled, -x_level, 0.0;
  return J;
}

Matrix3 down_in_body_jacobian(const EulerTrig& at) {
  Matrix3 J;
  J << 0.0, -at.c_theta, 0.0,                              //
      at.c_phi * at.c_theta, -at.s_phi * at.s_theta, 0.0,  //
      -at.s_phi * at.c_theta, -at.c_phi * at.s_theta, 0.0;
  return J;
}

Matrix3 euler_rate_jacobian(const EulerTrig& at, const Vector3& w_B) {
  const double pitch_rate = w_B.y() * at.c_phi - w_B.z() * at.s_phi;
  const double turn = w_B.y() * at.s_phi + w_B.z() * at.c_phi;
  Matrix3 J;
  J << pitch_rate * at.tangent, turn * at.secant * at.secant, 0.0,  //
      -turn, 0.0, 0.0,                                              //
      pitch_rate * at.secant, turn * at.tangent * at.secant, 0.0;
  return J;
}

Quaternion quaternion_NB(const Vector3& theta) {
  const double s_phi = std::sin(0.5 * theta.x());
  const double c_phi = std::cos(0.5 * theta.x());
  const double s_theta = std::sin(0.5 * theta.y());
  const double c_theta = std::cos(0.5 * theta.y());
  const double s_psi = std::sin(0.5 * theta.z());
  const double c_psi = std::cos(0.5 * theta.z());
  return Quaternion(
      c_psi * c_theta * c_phi + s_psi * s_theta * s_phi, c_psi * c_theta * s_phi - s_psi * s_theta * c_phi,
      c_psi * s_theta * c_phi + s_psi * c_theta * s_phi, s_psi * c_theta * c_phi - c_psi * s_theta * s_phi);
}

Vector3 euler_from_quaternion(const Quaternion& q_NB) {
  const double w = q_NB.w();
  const double x = q_NB.x();
  const double y = q_NB.y();
  const double z = q_NB.z();
  const double roll = std::atan2(2.0 * (w * x + y * z), w * w - x * x - y * y + z * z);
  const double pitch = std::asin(std::clamp(2.0 * (w * y - x * z), -1.0, 1.0));
  // Removing the roll first keeps the heading defined at pitch +-90 degrees.
  const double s_phi = std::sin(roll);
  const double c_phi = std::cos(roll);
  const double R_xy = 2.0 * (x * y - w * z);
  const double R_xz = 2.0 * (x * z + w * y);
  const double R_yy = w * w - x * x + y * y - z * z;
  const double R_yz = 2.0 * (y * z - w * x);
  const double heading = std::atan2(s_phi * R_xz - c_phi * R_xy, c_phi * R_yy - s_phi * R_yz);
  return {wrap(roll), pitch, wrap(heading)};
}

Vector3 canonical_euler(const Vector3& theta, bool& flipped) {
  constexpr double kHalfTurn = std::numbers::pi;
  const double pitch = wrap(theta.y());
  flipped = std::abs(pitch) > 0.5 * kHalfTurn;
  if (!flipped) return {wrap(theta.x()), pitch, wrap(theta.z())};
  return {wrap(theta.x() + kHalfTurn), wrap(kHalfTurn - pitch), wrap(theta.z() + kHalfTurn)};
}

Matrix3 skew(const Vector3& a) {
  Matrix3 m;
  m << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),   //
      -a.y(), a.x(), 0.0;
  return m;
}

}  // namespace ironbird::autopilot
