#include "autopilot/estimator/ekf_process.hpp"

#include "autopilot/estimator/covariance.hpp"
#include "autopilot/estimator/ekf_blocks.hpp"

namespace ironbird::autopilot {

EkfState::Vector ekf_dynamics(const EkfState& x, const EulerTrig& at, const EkfInput& u) {
  const Matrix3 R_NB = rotation_NB(at);
  const Vector3 w_NB_B = u.w_NB_B - x.gyro_bias_B;
  const Vector3 down_B = R_NB.row(2).transpose();
  EkfState::Vector x_dot;
  x_dot.segment<3>(kP) = R_NB * x.v_NB_B;
  x_dot.segment<3>(kV) = u.gravity * down_B + u.f_B + x.v_NB_B.cross(w_NB_B);
  x_dot.segment<3>(kT) = euler_rate_matrix(at) * w_NB_B;
  x_dot.segment<3>(kB).setZero();
  return x_dot;
}

EkfJacobian ekf_jacobian(const EkfState& x, const EulerTrig& at, const EkfInput& u) {
  const Vector3 w_NB_B = u.w_NB_B - x.gyro_bias_B;
  EkfJacobian A;
  A.pv = rotation_NB(at);
  A.pt = rotated_vector_jacobian(at, x.v_NB_B);
  A.vv = -skew(w_NB_B);
  A.vt = u.gravity * down_in_body_jacobian(at);
  A.vb = -skew(x.v_NB_B);
  A.tt = euler_rate_jacobian(at, w_NB_B);
  A.tb = -euler_rate_matrix(at);
  return A;
}

EkfState::Matrix EkfJacobian::full() const {
  EkfState::Matrix A = EkfState::Matrix::Zero();
  A.block<3, 3>(kP, kV) = pv;
  A.block<3, 3>(kP, kT) = pt;
  A.block<3, 3>(kV, kV) = vv;
  A.block<3, 3>(kV, kT) = vt;
  A.block<3, 3>(kV, kB) = vb;
  A.block<3, 3>(kT, kT) = tt;
  A.block<3, 3>(kT, kB) = tb;
  return A;
}

Eigen::Matrix<double, EkfState::kSize, 6> ekf_noise_jacobian(const EkfState& x, const EulerTrig& at) {
  constexpr int kAccelerometer = 0;
  constexpr int kGyro = 3;
  Eigen::Matrix<double, EkfState::kSize, 6> G = Eigen::Matrix<double, EkfState::kSize, 6>::Zero();
  G.block<3, 3>(kV, kAccelerometer) = -Matrix3::Identity();
  G.block<3, 3>(kV, kGyro) = -skew(x.v_NB_B);
  G.block<3, 3>(kT, kGyro) = -euler_rate_matrix(at);
  return G;
}

EkfTransition ekf_transition(const EkfJacobian& A, double h) {
  const double half = 0.5 * h * h;
  EkfTransition F;
  F.pv.noalias() = h * A.pv + half * A.pv.lazyProduct(A.vv);
  F.pt.noalias() = h * A.pt + half * (A.pv.lazyProduct(A.vt) + A.pt.lazyProduct(A.tt));
  F.pb.noalias() = half * (A.pv.lazyProduct(A.vb) + A.pt.lazyProduct(A.tb));
  F.vv.noalias() = Matrix3::Identity() + h * A.vv + half * A.vv.lazyProduct(A.vv);
  F.vt.noalias() = h * A.vt + half * (A.vv.lazyProduct(A.vt) + A.vt.lazyProduct(A.tt));
  F.vb.noalias() = h * A.vb + half * (A.vv.lazyProduct(A.vb) + A.vt.lazyProduct(A.tb));
  F.tt.noalias() = Matrix3::Identity() + h * A.tt + half * A.tt.lazyProduct(A.tt);
  F.tb.noalias() = h * A.tb + half * A.tt.lazyProduct(A.tb);
  return F;
}

EkfState::Matrix EkfTransition::full() const {
  EkfState::Matrix F = EkfState::Matrix::Identity();
  F.block<3, 3>(kP, kV) = pv;
  F.block<3, 3>(kP, kT) = pt;
  F.block<3, 3>(kP, kB) = pb;
  F.block<3, 3>(kV, kV) = vv;
  F.block<3, 3>(kV, kT) = vt;
  F.block<3, 3>(kV, kB) = vb;
  F.block<3, 3>(kT, kT) = tt;
  F.block<3, 3>(kT, kB) = tb;
  return F;
}

void ekf_propagate_covariance(EkfState::Matrix& P, const EkfTransition& F) {
  const Matrix3 pv = F.pv.transpose(), pt = F.pt.transpose(), pb = F.pb.transpose();
  const Matrix3 vv = F.vv.transpose(), vt = F.vt.transpose(), vb = F.vb.transpose();
  const Matrix3 tt = F.tt.transpose(), tb = F.tb.transpose();

  // N = P F^T, column block by column block, then M = N^T = F P.
  EkfState::Matrix N;
  N.middleCols<3>(kP) = P.middleCols<3>(kP) + P.middleCols<3>(kV).lazyProduct(pv) +
                        P.middleCols<3>(kT).lazyProduct(pt) + P.middleCols<3>(kB).lazyProduct(pb);
  N.middleCols<3>(kV) = P.middleCols<3>(kV).lazyProduct(vv) + P.middleCols<3>(kT).lazyProduct(vt) +
                        P.middleCols<3>(kB).lazyProduct(vb);
  N.middleCols<3>(kT) = P.middleCols<3>(kT).lazyProduct(tt) + P.middleCols<3>(kB).lazyProduct(tb);
  N.middleCols<3>(kB) = P.middleCols<3>(kB);
  const EkfState::Matrix M = N.transpose();

  // F P F^T = M F^T, upper triangle only.
  P.block<3, 3>(kP, kP) = M.block<3, 3>(kP, kP) + M.block<3, 3>(kP, kV).lazyProduct(pv) +
                          M.block<3, 3>(kP, kT).lazyProduct(pt) + M.block<3, 3>(kP, kB).lazyProduct(pb);
  P.block<6, 3>(kP, kV) = M.block<6, 3>(kP, kV).lazyProduct(vv) + M.block<6, 3>(kP, kT).lazyProduct(vt) +
                          M.block<6, 3>(kP, kB).lazyProduct(vb);
  P.block<9, 3>(kP, kT) = M.block<9, 3>(kP, kT).lazyProduct(tt) + M.block<9, 3>(kP, kB).lazyProduct(tb);
  P.block<9, 3>(kP, kB) = M.block<9, 3>(kP, kB);
  mirror_upper(P);
}

void ekf_add_noise(EkfState::Matrix& P, const EkfState& x, const EulerTrig& at, const EkfStepNoise& noise) {
  const Matrix3 v_cross = skew(x.v_NB_B);
  const Matrix3 S = euler_rate_matrix(at);
  P.diagonal() += noise.direct;
  // G = [0; -I, -[v]x; 0, -S; 0]: the two gyro blocks share their noise.
  P.block<3, 3>(kV, kV).diagonal().array() += noise.accelerometer;
  P.block<3, 3>(kV, kV) += noise.gyro * v_cross.lazyProduct(v_cross.transpose());
  const Matrix3 vt = noise.gyro * v_cross.lazyProduct(S.transpose());
  P.block<3, 3>(kV, kT) += vt;
  P.block<3, 3>(kT, kV) += vt.transpose();
  P.block<3, 3>(kT, kT) += noise.gyro * S.lazyProduct(S.transpose());
}

}  // namespace ironbird::autopilot
