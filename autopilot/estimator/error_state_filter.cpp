#include "autopilot/estimator/error_state_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "autopilot/estimator/covariance.hpp"
#include "autopilot/estimator/ekf_measurements.hpp"
#include "autopilot/estimator/error_state_blocks.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kLeastTurn = 1.0e-4;  // rad, below it the turn of the covariance is lost in it

}  // namespace

void ErrorStateFilter::reset() {
  AidedEstimator::reset();
  x_ = ErrorState{};
  P_.setIdentity();
  step_ = 0.0;
}

void ErrorStateFilter::start(const StartState& start) {
  const InitialSigmaParams& sigma = aiding().initial;
  const ErrorStateNoiseParams& q = params().noise;
  x_ = ErrorState{};
  x_.p_NB_N = start.p_NB_N;
  x_.v_NB_N = start.v_NB_N;
  x_.q_NB = start.q_NB;
  x_.gyro_bias_B = start.gyro_bias_B;
  const Vector3 down_B = start.q_NB.conjugate() * Vector3::UnitZ();
  const Matrix3 along = down_B * down_B.transpose();
  const Matrix3 across = Matrix3::Identity() - along;
  const double tilt = start.moving ? sigma.air_tilt : sigma.tilt;
  const double heading = start.moving ? sigma.air_heading : sigma.heading;
  const double vertical_bias = start.moving ? q.initial_accelerometer_bias : q.initial_vertical_bias;

  P_.setZero();
  P_.diagonal().segment<3>(kDp).setConstant(square(sigma.position));
  P_.diagonal().segment<3>(kDv).setConstant(square(start.moving ? sigma.air_velocity : sigma.velocity));
  P_.diagonal().segment<3>(kDg).setConstant(square(start.moving ? sigma.air_gyro_bias : sigma.gyro_bias));
  P_.diagonal().segment<3>(kDe).setConstant(square(q.gyro_misalignment));
  P_.diagonal().segment<3>(kDs).setConstant(square(q.gyro_scale));
  P_.diagonal().segment<3>(kDm).setConstant(square(q.mag));
  P_.block<3, 3>(kDa, kDa) = square(q.initial_accelerometer_bias) * across + square(vertical_bias) * along;
  P_.block<3, 3>(kDq, kDq) = square(tilt) * across + square(heading) * along;
  if (!start.moving) start_at_rest(down_B);
  if (!start.m_B.isZero()) start_heading(start.m_B, down_B);
}

void ErrorStateFilter::start_at_rest(const Vector3& down_B) {
  // The tilt came from the accelerometer, so its bias b tilts by -[down]x b/g (docs/equations.md, section 7).
  const Matrix3 tilt_from_bias = tilt_from_accelerometer_bias(down_B, aiding().gravity);
  const Matrix3 cross = tilt_from_bias * P_.block<3, 3>(kDa, kDa);
  P_.block<3, 3>(kDq, kDq) += cross * tilt_from_bias.transpose();
  P_.block<3, 3>(kDq, kDa) = cross;
  P_.block<3, 3>(kDa, kDq) = cross.transpose();
}

void ErrorStateFilter::start_heading(const Vector3& m_B, const Vector3& down_B) {
  const HeadingStart start = heading_start(x_, m_B, down_B, aiding().mag.declination);
  const Eigen::Matrix<double, ErrorState::kSize, 3> columns =
      P_.middleCols<3>(kDq).lazyProduct(start.from_tilt.transpose()) +
      P_.middleCols<3>(kDm).lazyProduct(start.from_bias.transpose());
  const Matrix3 attitude =
      start.from_tilt * columns.middleRows<3>(kDq) + start.from_bias * columns.middleRows<3>(kDm);
  P_.middleCols<3>(kDq) = columns;
  P_.middleRows<3>(kDq) = columns.transpose();
  P_.block<3, 3>(kDq, kDq) = 0.5 * (attitude + attitude.transpose());
}

void ErrorStateFilter::rebuild_step_constants(double h) {
  const ErrorStateNoiseParams& q = params().noise;
  step_ = h;
  decay_.gnss = std::exp(-h / q.gnss_time_constant);
  decay_.baro = std::exp(-h / q.baro_time_constant);
  decay_.mag = std::exp(-h / q.mag_time_constant);
  const double gnss = 1.0 - square(decay_.gnss);
  noise_.setZero();
  noise_.segment<3>(kDv).setConstant(square(q.accelerometer) * h);
  noise_.segment<3>(kDg).setConstant(square(q.gyro_bias) * h);
  noise_.segment<3>(kDa).setConstant(square(q.accelerometer_bias) * h);
  noise_.segment<3>(kDw) << square(q.gnss_horizontal) * gnss, square(q.gnss_horizontal) * gnss,
      square(q.gnss_vertical) * gnss;
  noise_(kDb) = square(q.baro) * (1.0 - square(decay_.baro));
  noise_.segment<3>(kDm).setConstant(square(q.mag) * (1.0 - square(decay_.mag)));
}

void ErrorStateFilter::predict(const Vector3& f_B, const Vector3& w_B, double dt) {
  if (dt != step_) rebuild_step_constants(dt);
  const ErrorStateNoiseParams& q = params().noise;
  noise_.segment<3>(kDq).setConstant((square(q.gyro) + square(q.gyro_per_vibration * vibration())) * dt);
  const EkfInput u{f_B, w_B, aiding().gravity};
  Matrix3 R_mid;
  const ErrorState next = error_state_propagate(x_, u, decay_, dt, R_mid);
  error_state_propagate_covariance(P_, error_transition(x_, u, R_mid, decay_, dt), noise_);
  x_ = next;
}

void ErrorStateFilter::inject(const ErrorState::Vector& correction) {
  x_ = x_.plus(correction);
  const Vector3 turn = correction.segment<3>(kDq);
  if (turn.squaredNorm() < kLeastTurn * kLeastTurn) return;
  // The attitude error is now measured from the turned attitude.
  const Matrix3 turned = error_after_turn(turn);
  const Eigen::Matrix<double, ErrorState::kSize, 3> columns =
      P_.middleCols<3>(kDq).lazyProduct(turned.transpose());
  const Matrix3 attitude = turned * columns.middleRows<3>(kDq);
  P_.middleCols<3>(kDq) = columns;
  P_.middleRows<3>(kDq) = columns.transpose();
  P_.block<3, 3>(kDq, kDq) = 0.5 * (attitude + attitude.transpose());
}

void ErrorStateFilter::correct_mag(const Vector3& m_B, Time now) {
  const MagParams& wanted = aiding().mag;
  const Vector3 field_B = m_B - x_.mag_bias_B;
  const double innovation = error_state_mag(x_, field_B, wanted.declination).innovation;
  const Vector3 down_B = x_.q_NB.conjugate() * Vector3::UnitZ();
  const ErrorMagModel model =
      error_state_mag(x_, expected_field(field_B, down_B, innovation), wanted.declination);
  // Noise of the unit vector turns the azimuth by itself over the horizontal part.
  const double noise = square(wanted.sigma) / std::max(model.levelness, kLeastLevelness);
  const double R = noise + square(wanted.sigma_tilt);
  const double gate_R = noise + square(std::min(wanted.sigma_tilt, wanted.gate_sigma));
  const ErrorState::Vector PCt = P_.middleCols<3>(kDq).lazyProduct(model.H_attitude.transpose()) +
                                 P_.middleCols<3>(kDm).lazyProduct(model.H_bias.transpose());
  const double CPCt = model.H_attitude.dot(PCt.segment<3>(kDq)) + model.H_bias.dot(PCt.segment<3>(kDm));
  const double S = CPCt + gate_R;
  innovations_.heading = innovation;
  reaches_.heading = Gate::reach(S, wanted.gate);
  const Verdict verdict = judge_mag(square(innovation) / S, now);
  if (verdict == Verdict::kReject) return;
  if (verdict == Verdict::kReset) {
    x_.q_NB = (Quaternion(Eigen::AngleAxisd(innovation, Vector3::UnitZ())) * x_.q_NB).normalized();
    P_.block<3, 3>(kDq, kDq) += gate_R * down_B * down_B.transpose();
    return;
  }
  Update update;
  update.fuse(P_, innovation, PCt, CPCt, 0.0, R);
  inject(update.correction);
}

void ErrorStateFilter::doubt_heading(double sigma) {
  const Vector3 down_B = x_.q_NB.conjugate() * Vector3::UnitZ();
  P_.block<3, 3>(kDq, kDq) += square(sigma) * down_B * down_B.transpose();
  // What was taken for the vehicle's own iron was found with that heading.
  x_.mag_bias_B.setZero();
  decorrelate(P_, kDm, 3, square(params().noise.mag));
}

void ErrorStateFilter::correct_baro(double difference, Time now) {
  const BaroParams& wanted = aiding().baro;
  const double p_d = x_.p_NB_N.z();
  const double C = baro_model().slope(p_d);
  const double R = square(wanted.sigma);
  const double innovation = difference - baro_model().pressure_difference(p_d) - x_.baro_walk;
  innovations_.pressure = innovation;
  const ErrorState::Vector PCt = C * P_.col(kDdown) + P_.col(kDb);
  const double CPCt = C * PCt(kDdown) + PCt(kDb);
  const double S = CPCt + R;
  reaches_.pressure = Gate::reach(S, wanted.gate);
  // With a velocity that may be wrong the height walks, and the filter would take it for a walk of the
  // pressure.
  if (velocity_disputed(now)) return;
  const Verdict verdict = baro_gate().judge(square(innovation) / S, wanted.gate, wanted.persistence, now);
  if (verdict == Verdict::kReject) return;
  if (verdict == Verdict::kReset) {
    // The receiver knows the height as well: it is the pressure that has stepped.
    decorrelate(P_, kDb, 1, R);
    x_.baro_walk += innovation;
    return;
  }
  Update update;
  update.fuse(P_, innovation, PCt, CPCt, 0.0, R);
  inject(update.correction);
}

void ErrorStateFilter::correct_gnss(const GnssObservation& fix, Time now) {
  Update update;
  fuse_velocity(fix, now, update);
  fuse_position(fix, now, update);
  inject(update.correction);
}

void ErrorStateFilter::fuse_velocity(const GnssObservation& fix, Time now, Update& update) {
  const GnssParams& wanted = aiding().gnss;
  Matrix3 S = P_.block<3, 3>(kDv, kDv);
  S.diagonal() += fix.variance_v;
  for (int axis = 0; axis < 3; ++axis) reaches_.v_N(axis) = Gate::reach(S(axis, axis), wanted.velocity_gate);
  const double nis = fix.dv_N.dot(S.inverse() * fix.dv_N);
  const Verdict verdict = velocity_gate().judge(nis, wanted.velocity_gate, wanted.persistence, now);
  if (verdict == Verdict::kAccept) {
    velocity_believed(now);
    for (int axis = 0; axis < 3; ++axis) {
      update.fuse_component(P_, fix.dv_N(axis), kDv + axis, 1.0, fix.variance_v(axis));
    }
  } else if (verdict == Verdict::kReset) {
    velocity_believed(now, fix.dv_N.norm());
    decorrelate(P_, kDv, 3, fix.variance_v.maxCoeff());
    P_(kDdown, kDdown) += square(height_lost(fix.dv_N.z()));
    update.correction.segment<3>(kDv) = fix.dv_N;
  }
}

void ErrorStateFilter::fuse_position(const GnssObservation& fix, Time now, Update& update) {
  const GnssParams& wanted = aiding().gnss;
  // h = p + walk: C picks both.
  const Vector3 innovation = fix.dp_N - x_.gnss_walk_N;
  const Vector3 left = innovation - update.correction.segment<3>(kDp) - update.correction.segment<3>(kDw);
  Matrix3 S = P_.block<3, 3>(kDp, kDp) + P_.block<3, 3>(kDp, kDw) + P_.block<3, 3>(kDw, kDp) +
              P_.block<3, 3>(kDw, kDw);
  S.diagonal() += fix.gate_variance_p;
  innovations_.p_N = left;
  for (int axis = 0; axis < 3; ++axis) reaches_.p_N(axis) = Gate::reach(S(axis, axis), wanted.position_gate);
  const double nis = left.dot(S.inverse() * left);
  const Verdict verdict = position_gate().judge(nis, wanted.position_gate, wanted.persistence, now);
  if (verdict == Verdict::kAccept) {
    position_believed(now);
    for (int axis = 0; axis < 3; ++axis) {
      const ErrorState::Vector PCt = P_.col(kDp + axis) + P_.col(kDw + axis);
      update.fuse(P_, innovation(axis), PCt, PCt(kDp + axis) + PCt(kDw + axis),
                  update.correction(kDp + axis) + update.correction(kDw + axis), fix.variance_p(axis));
    }
  } else if (verdict == Verdict::kReset) {
    if (!blame_receiver(innovation, now)) {
      decorrelate(P_, kDp, 2, fix.gate_variance_p.x());
      update.correction.segment<2>(kDp) = innovation.head<2>() - update.correction.segment<2>(kDw);
    }
    // Height has the barometer as well: there it is the receiver that has stepped.
    decorrelate(P_, kDw + 2, 1, fix.variance_p.z());
    update.correction(kDw + 2) = innovation.z() - update.correction(kDp + 2);
  }
}

bool ErrorStateFilter::is_finite() const {
  const double sum = x_.p_NB_N.sum() + x_.v_NB_N.sum() + x_.q_NB.coeffs().sum() + x_.gyro_bias_B.sum() +
                     x_.gyro_misalignment_B.sum() + x_.gyro_scale_B.sum() + x_.accelerometer_bias_B.sum() +
                     x_.gnss_walk_N.sum() + x_.baro_walk + x_.mag_bias_B.sum();
  return std::isfinite(sum) && std::isfinite(P_.diagonal().sum()) && P_.diagonal().minCoeff() >= 0.0;
}

void ErrorStateFilter::publish(StateEstimate& estimate) const {
  const Matrix3 R_NB = x_.q_NB.toRotationMatrix();
  const Vector3 theta = euler_from_quaternion(x_.q_NB);
  estimate.p_NB_N = x_.p_NB_N;
  estimate.v_NB_B = R_NB.transpose() * x_.v_NB_N;
  estimate.q_NB = x_.q_NB;
  estimate.roll = theta.x();
  estimate.pitch = theta.y();
  estimate.heading = theta.z();
  estimate.gyro_bias_B = x_.gyro_bias_B;
  estimate.accelerometer_bias_B = x_.accelerometer_bias_B;
  estimate.sigma_p_N = root_of(P_.diagonal().segment<3>(kDp));
  const Eigen::Matrix<double, 3, 6> J = error_body_velocity(R_NB, estimate.v_NB_B);
  const Eigen::Matrix<double, 3, 6> JP = J.lazyProduct(P_.block<6, 6>(kDv, kDv));
  estimate.sigma_v_B = root_of((JP.cwiseProduct(J)).rowwise().sum());
  const Matrix3 S = euler_rate_matrix(EulerTrig(theta));
  const Matrix3 SP = S.lazyProduct(P_.block<3, 3>(kDq, kDq));
  estimate.sigma_attitude = root_of((SP.cwiseProduct(S)).rowwise().sum());
}

void ErrorStateFilter::probe_filter(ProbeVisitor& visit) const {
  visit("gyro_bias", x_.gyro_bias_B, "rad/s");
  visit("sigma_gyro_bias", root_of(P_.diagonal().segment<3>(kDg)), "rad/s");
  visit("gyro_misalignment", x_.gyro_misalignment_B, "rad");
  visit("sigma_gyro_misalignment", root_of(P_.diagonal().segment<3>(kDe)), "rad");
  visit("gyro_scale", x_.gyro_scale_B, "1");
  visit("sigma_gyro_scale", root_of(P_.diagonal().segment<3>(kDs)), "1");
  visit("accelerometer_bias", x_.accelerometer_bias_B, "m/s^2");
  visit("sigma_accelerometer_bias", root_of(P_.diagonal().segment<3>(kDa)), "m/s^2");
  visit("gnss_walk", x_.gnss_walk_N, "m");
  visit("baro_walk", x_.baro_walk, "Pa");
  visit("mag_bias", x_.mag_bias_B, "1");
  visit("sigma_mag_bias", root_of(P_.diagonal().segment<3>(kDm)), "1");
}

}  // namespace ironbird::autopilot
