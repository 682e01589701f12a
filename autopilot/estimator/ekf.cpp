#include "autopilot/estimator/ekf.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "autopilot/estimator/covariance.hpp"
#include "autopilot/estimator/ekf_blocks.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

namespace {

using Update = ScalarUpdate<EkfState::kSize>;

}  // namespace

void Ekf::reset() {
  AidedEstimator::reset();
  x_ = EkfState{};
  trig_ = EulerTrig{};
  P_.setIdentity();
}

void Ekf::start(const StartState& start) {
  const InitialSigmaParams& sigma = aiding().initial;
  x_.p_NB_N = start.p_NB_N;
  x_.v_NB_B = start.q_NB.conjugate() * start.v_NB_N;
  set_attitude(euler_from_quaternion(start.q_NB));
  x_.gyro_bias_B = start.gyro_bias_B;
  const double tilt = start.moving ? sigma.air_tilt : sigma.tilt;
  const double heading = start.moving ? sigma.air_heading : sigma.heading;
  P_.setZero();
  P_.diagonal().segment<3>(kP).setConstant(square(sigma.position));
  P_.diagonal().segment<3>(kV).setConstant(square(start.moving ? sigma.air_velocity : sigma.velocity));
  P_.diagonal().segment<3>(kT) << square(tilt), square(tilt), square(heading);
  P_.diagonal().segment<3>(kB).setConstant(square(start.moving ? sigma.air_gyro_bias : sigma.gyro_bias));
}

void Ekf::set_attitude(const Vector3& theta) {
  bool flipped = false;
  x_.theta = canonical_euler(theta, flipped);
  trig_ = EulerTrig(x_.theta);
  if (!flipped) return;
  // (phi, theta, psi) and (phi + pi, pi - theta, psi + pi) are one attitude; the error of theta changes sign.
  P_.row(kPitch) *= -1.0;
  P_.col(kPitch) *= -1.0;
}

EkfStepNoise Ekf::step_noise(const Vector3& w_B, double h) const {
  const EkfNoiseParams& q = params().noise;
  const double scale = q.reference_scaling ? h * h : h;
  EkfStepNoise noise;
  noise.direct << q.position, q.position, q.height, q.velocity, q.velocity, q.velocity_down, q.roll_pitch,
      q.roll_pitch, q.heading, q.gyro_bias, q.gyro_bias, q.gyro_bias;
  noise.direct *= scale;
  noise.accelerometer = square(q.accelerometer) * scale;
  noise.gyro = (square(q.gyro) + square(q.gyro_per_rate) * (w_B - x_.gyro_bias_B).squaredNorm() +
                square(q.gyro_per_vibration * vibration())) *
               scale;
  return noise;
}

void Ekf::predict(const Vector3& f_B, const Vector3& w_B, double dt) {
  const EkfInput u{f_B, w_B, aiding().gravity};
  const int steps = params().propagation_steps;
  const double h = dt / steps;
  const EkfStepNoise noise = step_noise(w_B, h);
  for (int i = 0; i < steps; ++i) {
    const EkfState before = x_;
    const EulerTrig trig_before = trig_;
    const EkfState::Vector x_dot = ekf_dynamics(before, trig_before, u);
    const bool late = params().jacobian_at_new_state;
    if (late) apply(x_dot * h);
    const EkfState& point = late ? x_ : before;
    const EulerTrig& trig = late ? trig_ : trig_before;
    ekf_propagate_covariance(P_, ekf_transition(ekf_jacobian(point, trig, u), h));
    ekf_add_noise(P_, point, trig, noise);
    if (!late) apply(x_dot * h);
  }
}

void Ekf::apply(const EkfState::Vector& correction) {
  x_.p_NB_N += correction.segment<3>(kP);
  x_.v_NB_B += correction.segment<3>(kV);
  x_.gyro_bias_B += correction.segment<3>(kB);
  set_attitude(x_.theta + correction.segment<3>(kT));
}

void Ekf::correct_mag(const Vector3& m_B, Time now) {
  const MagParams& wanted = aiding().mag;
  const double heading = ekf_mag(m_B, trig_, wanted.declination).y;
  const double innovation = shortest_difference(heading, x_.theta.z());
  const Vector3 down_B = rotation_NB(trig_).row(2).transpose();
  const MagModel model = ekf_mag(expected_field(m_B, down_B, innovation), trig_, wanted.declination);
  const double R = model.R(square(wanted.sigma), square(wanted.sigma_tilt));
  const Eigen::Matrix<double, 1, 3> H = model.H();
  const double gate_R = model.R(square(wanted.sigma), square(std::min(wanted.sigma_tilt, wanted.gate_sigma)));
  const double S = H * P_.block<3, 3>(kT, kT) * H.transpose() + gate_R;
  innovations_.heading = innovation;
  reaches_.heading = Gate::reach(S, wanted.gate);
  const Verdict verdict = judge_mag(square(innovation) / S, now);
  if (verdict == Verdict::kReject) return;
  if (verdict == Verdict::kReset) {
    set_heading(heading, gate_R);
    return;
  }
  Update update;
  update.fuse_block<3>(P_, innovation, H, kT, R);
  apply(update.correction);
}

void Ekf::set_heading(double heading, double variance) {
  // The satellites know v_N. It must not turn with the heading: P goes over to v_N and back with the new
  // axes.
  const Vector3 v_N = rotation_NB(trig_) * x_.v_NB_B;
  const EkfState::Matrix to_v_N = ekf_to_v_N(x_, trig_);
  P_ = to_v_N * P_ * to_v_N.transpose();
  decorrelate(P_, kHeading, 1, variance);
  set_attitude({x_.theta.x(), x_.theta.y(), heading});
  const Matrix3 R_BN = rotation_NB(trig_).transpose();
  x_.v_NB_B = R_BN * v_N;
  const EkfState::Matrix from_v_N = ekf_from_v_N(x_, trig_);
  P_ = from_v_N * P_ * from_v_N.transpose();
  mirror_upper(P_);
}

void Ekf::doubt_heading(double sigma) {
  // As in set_heading: v_N is known and does not turn with the heading.
  const EkfState::Matrix to_v_N = ekf_to_v_N(x_, trig_);
  P_ = to_v_N * P_ * to_v_N.transpose();
  P_(kHeading, kHeading) += square(sigma);
  const EkfState::Matrix from_v_N = ekf_from_v_N(x_, trig_);
  P_ = from_v_N * P_ * from_v_N.transpose();
  mirror_upper(P_);
}

void Ekf::correct_baro(double difference, Time now) {
  const BaroParams& wanted = aiding().baro;
  const double C = baro_model().slope(x_.p_NB_N.z());
  const double R = square(wanted.sigma);
  const double innovation = difference - baro_model().pressure_difference(x_.p_NB_N.z());
  innovations_.pressure = innovation;
  const double S = C * P_(kDown, kDown) * C + R;
  reaches_.pressure = Gate::reach(S, wanted.gate);
  const Verdict verdict = baro_gate().judge(square(innovation) / S, wanted.gate, wanted.persistence, now);
  if (verdict == Verdict::kReject) return;
  if (verdict == Verdict::kReset) {
    decorrelate(P_, kDown, 1, R / square(C));
    x_.p_NB_N.z() += innovation / C;
    return;
  }
  Update update;
  update.fuse_component(P_, innovation, kDown, C, R);
  apply(update.correction);
}

void Ekf::correct_gnss(const GnssObservation& fix, Time now) {
  // The paper's joint measurement of five components, row by row at one linearisation point.
  Update update;
  fuse_velocity(fix, now, update);
  fuse_position(fix, now, update);
  apply(update.correction);
}

void Ekf::fuse_velocity(const GnssObservation& fix, Time now, Update& update) {
  const GnssParams& wanted = aiding().gnss;
  const GnssVelocityModel model = ekf_gnss_velocity(x_, trig_);
  Matrix3 S = model.C * P_.block<6, 6>(kV, kV) * model.C.transpose();
  S.diagonal() += fix.variance_v;
  for (int axis = 0; axis < 3; ++axis) reaches_.v_N(axis) = Gate::reach(S(axis, axis), wanted.velocity_gate);
  const double nis = fix.dv_N.dot(S.inverse() * fix.dv_N);
  const Verdict verdict = velocity_gate().judge(nis, wanted.velocity_gate, wanted.persistence, now);
  if (verdict == Verdict::kAccept) {
    velocity_believed(now);
    for (int axis = 0; axis < 3; ++axis) {
      update.fuse_block<6>(P_, fix.dv_N(axis), model.C.row(axis), kV, fix.variance_v(axis));
    }
  } else if (verdict == Verdict::kReset) {
    velocity_believed(now, fix.dv_N.norm());
    decorrelate(P_, kV, 3, fix.variance_v.maxCoeff());
    P_(kDown, kDown) += square(height_lost(fix.dv_N.z()));
    x_.v_NB_B += model.C.leftCols<3>().transpose() * fix.dv_N;
  }
}

void Ekf::fuse_position(const GnssObservation& fix, Time now, Update& update) {
  const GnssParams& wanted = aiding().gnss;
  const Vector2 innovation = fix.dp_N.head<2>() - update.correction.segment<2>(kP);
  Eigen::Matrix2d S = P_.block<2, 2>(kP, kP);
  S.diagonal() += fix.gate_variance_p.head<2>();
  innovations_.p_N.head<2>() = innovation;
  for (int axis = 0; axis < 2; ++axis) reaches_.p_N(axis) = Gate::reach(S(axis, axis), wanted.position_gate);
  const double nis = innovation.dot(S.inverse() * innovation);
  const Verdict verdict = position_gate().judge(nis, wanted.position_gate, wanted.persistence, now);
  if (verdict == Verdict::kAccept) {
    position_believed(now);
    for (int axis = 0; axis < 2; ++axis) {
      update.fuse_component(P_, fix.dp_N(axis), kP + axis, 1.0, fix.variance_p(axis));
    }
  } else if (verdict == Verdict::kReset && !blame_receiver(fix.dp_N, now)) {
    decorrelate(P_, kP, 2, fix.gate_variance_p.x());
    update.correction.segment<2>(kP) = fix.dp_N.head<2>();
  }
}

AidedEstimator::Kinematics Ekf::kinematics() const {
  return {x_.p_NB_N, rotation_NB(trig_) * x_.v_NB_B};
}

bool Ekf::is_finite() const {
  // A number that is not finite anywhere in P reaches the diagonal with the next step.
  return std::isfinite(x_.stacked().sum()) && std::isfinite(P_.diagonal().sum()) &&
         P_.diagonal().minCoeff() >= 0.0;
}

void Ekf::publish(StateEstimate& estimate) const {
  estimate.p_NB_N = x_.p_NB_N;
  estimate.v_NB_B = x_.v_NB_B;
  estimate.q_NB = Quaternion(rotation_NB(trig_)).normalized();
  estimate.roll = x_.theta.x();
  estimate.pitch = x_.theta.y();
  estimate.heading = x_.theta.z();
  estimate.gyro_bias_B = x_.gyro_bias_B;
  estimate.sigma_p_N = root_of(P_.diagonal().segment<3>(kP));
  estimate.sigma_v_B = root_of(P_.diagonal().segment<3>(kV));
  estimate.sigma_attitude = root_of(P_.diagonal().segment<3>(kT));
}

void Ekf::probe_filter(ProbeVisitor& visit) const {
  visit("gyro_bias", x_.gyro_bias_B, "rad/s");
  visit("sigma_gyro_bias", root_of(P_.diagonal().segment<3>(kB)), "rad/s");
}

}  // namespace ironbird::autopilot
