#include "autopilot/estimator/error_state_process.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/estimator/covariance.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/error_state_blocks.hpp"
#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

Vector3 corrected_rate(const ErrorState& x, const Vector3& w_NB_B) {
  const Vector3 u_B = w_NB_B - x.gyro_bias_B;
  return u_B + x.gyro_misalignment_B.cross(u_B) + x.gyro_scale_B.cwiseProduct(u_B);
}

ErrorState error_state_propagate(const ErrorState& x, const EkfInput& u, const WalkDecay& decay, double h,
                                 Matrix3& R_mid) {
  const Vector3 half_turn_B = (0.5 * h) * corrected_rate(x, u.w_NB_B);
  const Quaternion half = exponential(half_turn_B);
  const Quaternion q_mid = x.q_NB * half;
  R_mid = q_mid.toRotationMatrix();
  const Vector3 f_B = u.f_B - x.accelerometer_bias_B;
  const Vector3 a_N = R_mid * f_B + u.gravity * Vector3::UnitZ();
  ErrorState next = x;
  next.p_NB_N += h * x.v_NB_N + (0.5 * h * h) * a_N;
  next.v_NB_N += h * a_N;
  next.q_NB = (q_mid * half).normalized();
  next.gnss_walk_N *= decay.gnss;
  next.baro_walk *= decay.baro;
  next.mag_bias_B *= decay.mag;
  return next;
}

ErrorTransition error_transition(const ErrorState& x, const EkfInput& u, const Matrix3& R_mid,
                                 const WalkDecay& decay, double h) {
  const double half = 0.5 * h * h;
  const Matrix3 w_cross = skew(corrected_rate(x, u.w_NB_B));
  // w = (I + [misalignment]x + diag(scale)) u with u the reading less its bias.
  const Vector3 u_B = u.w_NB_B - x.gyro_bias_B;
  ErrorTransition::GyroBlock w_by_gyro;
  w_by_gyro << -Matrix3::Identity() - skew(x.gyro_misalignment_B) - Matrix3(x.gyro_scale_B.asDiagonal()),
      -skew(u_B), Matrix3(u_B.asDiagonal());
  const Matrix3 A_vt = -R_mid * skew(u.f_B - x.accelerometer_bias_B);
  ErrorTransition F;
  F.h = h;
  F.decay = decay;
  F.pt = half * A_vt;
  F.pa = -half * R_mid;
  F.vt = h * A_vt - half * A_vt.lazyProduct(w_cross);
  F.vg = (half * A_vt).lazyProduct(w_by_gyro);
  F.va = -h * R_mid;
  F.tt = Matrix3::Identity() - h * w_cross + half * w_cross.lazyProduct(w_cross);
  F.tg = (h * Matrix3::Identity() - half * w_cross).lazyProduct(w_by_gyro);
  return F;
}

ErrorState::Matrix ErrorTransition::full() const {
  ErrorState::Matrix F = ErrorState::Matrix::Identity();
  F.block<3, 3>(kDp, kDv) = h * Matrix3::Identity();
  F.block<3, 3>(kDp, kDq) = pt;
  F.block<3, 3>(kDp, kDa) = pa;
  F.block<3, 3>(kDv, kDq) = vt;
  F.block<3, 9>(kDv, kDg) = vg;
  F.block<3, 3>(kDv, kDa) = va;
  F.block<3, 3>(kDq, kDq) = tt;
  F.block<3, 9>(kDq, kDg) = tg;
  F.block<3, 3>(kDw, kDw) *= decay.gnss;
  F(kDb, kDb) = decay.baro;
  F.block<3, 3>(kDm, kDm) *= decay.mag;
  return F;
}

void error_state_propagate_covariance(ErrorState::Matrix& P, const ErrorTransition& F,
                                      const ErrorState::Vector& noise) {
  constexpr int kAll = ErrorState::kSize;
  constexpr int kMoving = kDg;  // position, velocity, attitude; all behind them is constant or fades
  const Matrix3 pt = F.pt.transpose(), pa = F.pa.transpose();
  const Matrix3 vt = F.vt.transpose(), va = F.va.transpose(), tt = F.tt.transpose();
  const Eigen::Matrix<double, 9, 3> vg = F.vg.transpose(), tg = F.tg.transpose();

  // N = P F^T, of the columns that move, block by block.
  Eigen::Matrix<double, kAll, kMoving> N;
  N.middleCols<3>(kDp) = P.middleCols<3>(kDp) + F.h * P.middleCols<3>(kDv) +
                         P.middleCols<3>(kDq).lazyProduct(pt) + P.middleCols<3>(kDa).lazyProduct(pa);
  N.middleCols<3>(kDv) = P.middleCols<3>(kDv) + P.middleCols<3>(kDq).lazyProduct(vt) +
                         P.middleCols<9>(kDg).lazyProduct(vg) + P.middleCols<3>(kDa).lazyProduct(va);
  N.middleCols<3>(kDq) = P.middleCols<3>(kDq).lazyProduct(tt) + P.middleCols<9>(kDg).lazyProduct(tg);
  const Eigen::Matrix<double, kMoving, kAll> M = N.transpose();

  // F P F^T, upper triangle: of what moves M F^T, beside it M and its fading.
  P.block<3, 3>(kDp, kDp) = M.block<3, 3>(kDp, kDp) + F.h * M.block<3, 3>(kDp, kDv) +
                            M.block<3, 3>(kDp, kDq).lazyProduct(pt) + M.block<3, 3>(kDp, kDa).lazyProduct(pa);
  P.block<6, 3>(kDp, kDv) = M.block<6, 3>(kDp, kDv) + M.block<6, 3>(kDp, kDq).lazyProduct(vt) +
                            M.block<6, 9>(kDp, kDg).lazyProduct(vg) + M.block<6, 3>(kDp, kDa).lazyProduct(va);
  P.block<9, 3>(kDp, kDq) = M.block<9, 3>(kDp, kDq).lazyProduct(tt) + M.block<9, 9>(kDp, kDg).lazyProduct(tg);
  P.block<kMoving, 12>(kDp, kDg) = M.block<kMoving, 12>(kDp, kDg);
  P.block<kMoving, 3>(kDp, kDw) = F.decay.gnss * M.block<kMoving, 3>(kDp, kDw);
  P.block<kMoving, 1>(kDp, kDb) = F.decay.baro * M.col(kDb);
  P.block<kMoving, 3>(kDp, kDm) = F.decay.mag * M.block<kMoving, 3>(kDp, kDm);
  // Among the constants nothing changes; each walk fades in its rows, then in its columns.
  P.block<3, kAll - kDw>(kDw, kDw) *= F.decay.gnss;
  P.block<1, kAll - kDb>(kDb, kDb) *= F.decay.baro;
  P.block<3, kAll - kDm>(kDm, kDm) *= F.decay.mag;
  P.block<kDw + 3 - kMoving, 3>(kMoving, kDw) *= F.decay.gnss;
  P.block<kDb + 1 - kMoving, 1>(kMoving, kDb) *= F.decay.baro;
  P.block<kAll - kMoving, 3>(kMoving, kDm) *= F.decay.mag;
  P.diagonal() += noise;
  mirror_upper(P);
}

ErrorMagModel error_state_mag(const ErrorState& x, const Vector3& m_B, double declination) {
  const Matrix3 R_NB = x.q_NB.toRotationMatrix();
  const Vector3 m_N = R_NB * m_B;
  ErrorMagModel model;
  model.levelness = m_N.head<2>().squaredNorm();
  model.innovation = shortest_difference(declination, std::atan2(m_N.y(), m_N.x()));
  // d azimuth = (m_x dm_y - m_y dm_x)/(m_x^2 + m_y^2), and R Exp(e) m = R m - R [m]x e.
  const double divisor = std::max(model.levelness, kLeastLevelness);
  const Eigen::Matrix<double, 1, 3> azimuth(-m_N.y() / divisor, m_N.x() / divisor, 0.0);
  model.H_attitude = -azimuth * R_NB * skew(m_B);
  model.H_bias = -azimuth * R_NB;
  return model;
}

Eigen::Matrix<double, 3, 6> error_body_velocity(const Matrix3& R_NB, const Vector3& v_NB_B) {
  // v_B = R^T v: its error is R^T dv + [v_B]x dtheta.
  Eigen::Matrix<double, 3, 6> J;
  J << R_NB.transpose(), skew(v_NB_B);
  return J;
}

Matrix3 error_after_turn(const Vector3& turn) {
  // Log(Exp(-turn) Exp(e)) = (I - [turn]x/2)(e - turn).
  return Matrix3::Identity() - 0.5 * skew(turn);
}

Matrix3 tilt_from_accelerometer_bias(const Vector3& down_B, double gravity) {
  return skew(down_B) * (-1.0 / gravity);
}

HeadingStart heading_start(const ErrorState& x, const Vector3& m_B, const Vector3& down_B,
                           double declination) {
  // Tilt t and compass bias b turn the heading by -(H_t t + H_b b).
  const ErrorMagModel model = error_state_mag(x, m_B, declination);
  const Matrix3 across = Matrix3::Identity() - down_B * down_B.transpose();
  HeadingStart attitude;
  attitude.from_tilt = Matrix3::Identity() - down_B * model.H_attitude * across;
  attitude.from_bias = -down_B * model.H_bias;
  return attitude;
}

}  // namespace ironbird::autopilot
