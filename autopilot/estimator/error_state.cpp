#include "autopilot/estimator/error_state.hpp"

#include <cmath>

namespace ironbird::autopilot {

namespace {

constexpr double kSmallAngle = 1.0e-4;  // rad, below it the series are exact to rounding

}  // namespace

Quaternion exponential(const Vector3& turn) {
  const double squared = turn.squaredNorm();
  if (squared < kSmallAngle * kSmallAngle) {
    const double half_sinc = 0.5 - squared / 48.0;
    return Quaternion(1.0 - squared / 8.0, half_sinc * turn.x(), half_sinc * turn.y(), half_sinc * turn.z());
  }
  const double angle = std::sqrt(squared);
  const double scale = std::sin(0.5 * angle) / angle;
  return Quaternion(std::cos(0.5 * angle), scale * turn.x(), scale * turn.y(), scale * turn.z());
}

Vector3 logarithm(const Quaternion& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Vector3 axis = sign * q.vec();
  const double sine = axis.norm();
  const double cosine = sign * q.w();
  if (sine < kSmallAngle) return axis * (2.0 / cosine) * (1.0 - sine * sine / (3.0 * cosine * cosine));
  return axis * (2.0 * std::atan2(sine, cosine) / sine);
}

ErrorState ErrorState::plus(const Vector& error) const {
  ErrorState x = *this;
  x.p_NB_N += error.segment<3>(kPosition);
  x.v_NB_N += error.segment<3>(kVelocity);
  x.q_NB = (q_NB * exponential(error.segment<3>(kAttitude))).normalized();
  x.gyro_bias_B += error.segment<3>(kGyroBias);
  x.gyro_misalignment_B += error.segment<3>(kGyroMisalignment);
  x.gyro_scale_B += error.segment<3>(kGyroScale);
  x.accelerometer_bias_B += error.segment<3>(kAccelerometerBias);
  x.gnss_walk_N += error.segment<3>(kGnssWalk);
  x.baro_walk += error(kBaroWalk);
  x.mag_bias_B += error.segment<3>(kMagBias);
  return x;
}

ErrorState::Vector ErrorState::minus(const ErrorState& estimate) const {
  Vector error;
  error << p_NB_N - estimate.p_NB_N, v_NB_N - estimate.v_NB_N, logarithm(estimate.q_NB.conjugate() * q_NB),
      gyro_bias_B - estimate.gyro_bias_B, gyro_misalignment_B - estimate.gyro_misalignment_B,
      gyro_scale_B - estimate.gyro_scale_B, accelerometer_bias_B - estimate.accelerometer_bias_B,
      gnss_walk_N - estimate.gnss_walk_N, baro_walk - estimate.baro_walk, mag_bias_B - estimate.mag_bias_B;
  return error;
}

}  // namespace ironbird::autopilot
