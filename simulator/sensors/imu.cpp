#include "simulator/sensors/imu.hpp"

#include <cmath>

namespace ironbird::simulator {

namespace {

/// Sum over the rotors of speed to the fourth power, (rad/s)^4.
double unbalance(const Truth& truth) {
  double sum = 0.0;
  for (const double speed : truth.rotor_speed) sum += (speed * speed) * (speed * speed);
  return sum;
}

/// Standard deviation of the chip's noise together with the rotors' vibration.
double in_quadrature(double sigma, double vibration, double unbalanced) {
  return std::sqrt(sigma * sigma + vibration * vibration * unbalanced);
}

}  // namespace

Imu::Imu(const ImuParams& params, const SensorSite& site, double period, std::uint64_t seed)
    : params_(params),
      R_SB_(params.mounting.R_BS().transpose()),
      gravity_(site.gravity),
      accelerometer_(params.accelerometer, period, seed, "sensors/imu/accelerometer"),
      gyro_(params.gyro, period, seed, "sensors/imu/gyro") {}

Vector3 Imu::specific_force_B(const Truth& truth) const {
  if (params_.rest_speed > 0.0 && truth.v_NB_N.norm() < params_.rest_speed) {
    return truth.q_NB.conjugate() * Vector3(0.0, 0.0, -gravity_);
  }
  const Vector3& r_B = params_.mounting.p_BS_B;
  const Vector3& w_B = truth.w_NB_B;
  return truth.f_B + truth.w_dot_NB_B.cross(r_B) + w_B.cross(w_B.cross(r_B));
}

ImuReading Imu::measure(const Truth& truth, Time now, const FaultState& faults, bool armed) {
  const double unbalanced = unbalance(truth);
  const bool noisy = armed || !params_.noise_only_when_armed;
  const double sigma_f =
      noisy ? in_quadrature(accelerometer_.white_sigma(), params_.accelerometer_vibration, unbalanced) : 0.0;
  const double sigma_w = noisy ? in_quadrature(gyro_.white_sigma(), params_.gyro_vibration, unbalanced) : 0.0;

  ImuReading reading;
  reading.taken = now;
  reading.f_B = accelerometer_.apply(R_SB_ * specific_force_B(truth), faults.accelerometer_bias, sigma_f);
  reading.w_NB_B = gyro_.apply(R_SB_ * truth.w_NB_B, faults.gyro_bias, sigma_w);
  reading.temperature = params_.temperature;
  return reading;
}

}  // namespace ironbird::simulator
