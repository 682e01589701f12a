#pragma once

#include <Eigen/Core>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// The state of the quaternion error-state filter and the blocks of its error.
///
/// The error of the attitude is a small rotation in B: q_true = q_NB * Exp(error). All other errors are
/// differences, true less estimated. `gnss_walk`, `baro_walk` and `mag_bias` are the slow errors of the
/// receiver, the barometer and the compass. The true rate is u + misalignment x u + scale * u (by components)
/// with u the gyro's reading less its bias.
struct ErrorState {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kAttitude = 6;
  static constexpr int kGyroBias = 9;
  static constexpr int kGyroMisalignment = 12;
  static constexpr int kGyroScale = 15;
  static constexpr int kAccelerometerBias = 18;
  static constexpr int kGnssWalk = 21;
  static constexpr int kBaroWalk = 24;
  static constexpr int kMagBias = 25;
  static constexpr int kSize = 28;

  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Vector3 p_NB_N = Vector3::Zero();
  Vector3 v_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 gyro_bias_B = Vector3::Zero();
  Vector3 gyro_misalignment_B = Vector3::Zero();
  Vector3 gyro_scale_B = Vector3::Zero();
  Vector3 accelerometer_bias_B = Vector3::Zero();
  Vector3 gnss_walk_N = Vector3::Zero();
  double baro_walk = 0.0;
  Vector3 mag_bias_B = Vector3::Zero();

  /// The state that an estimate with this error stands for.
  ErrorState plus(const Vector& error) const;

  /// The error of `estimate` when this state is true: estimate.plus(error) is this.
  Vector minus(const ErrorState& estimate) const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_NB_N", self.p_NB_N, "m", "position of B from the local origin");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity over ground");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("gyro_bias_B", self.gyro_bias_B, "rad/s", "bias of the gyro");
    visit("gyro_misalignment_B", self.gyro_misalignment_B, "rad", "turn of the gyro's axes");
    visit("gyro_scale_B", self.gyro_scale_B, "1", "what is missing of each axis of the gyro, relative");
    visit("accelerometer_bias_B", self.accelerometer_bias_B, "m/s^2", "bias of the accelerometer");
    visit("gnss_walk_N", self.gnss_walk_N, "m", "slow error of the satellite position");
    visit("baro_walk", self.baro_walk, "Pa", "slow error of the pressure difference");
    visit("mag_bias_B", self.mag_bias_B, "1", "slow error of the field's unit vector");
  }
};

/// The rotation by the vector `turn`, rad.
Quaternion exponential(const Vector3& turn);

/// The shortest rotation vector of a unit quaternion, rad.
Vector3 logarithm(const Quaternion& q);

}  // namespace ironbird::autopilot
