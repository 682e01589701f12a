#pragma once

#include <Eigen/Core>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// The state of the filter of the ROScopter paper, x = (p, v, Theta, b), and where its blocks are.
///
/// p: position in N, m. v: velocity over ground in B, m/s. Theta: roll, pitch, heading, rad. b: gyro bias in
/// B, rad/s.
struct EkfState {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kAttitude = 6;
  static constexpr int kHeading = 8;
  static constexpr int kGyroBias = 9;
  static constexpr int kSize = 12;

  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Vector3 p_NB_N = Vector3::Zero();
  Vector3 v_NB_B = Vector3::Zero();
  Vector3 theta = Vector3::Zero();
  Vector3 gyro_bias_B = Vector3::Zero();

  Vector stacked() const {
    Vector x;
    x << p_NB_N, v_NB_B, theta, gyro_bias_B;
    return x;
  }

  static EkfState from(const Vector& x) {
    return {x.segment<3>(kPosition), x.segment<3>(kVelocity), x.segment<3>(kAttitude),
            x.segment<3>(kGyroBias)};
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_NB_N", self.p_NB_N, "m", "position of B from the local origin");
    visit("v_NB_B", self.v_NB_B, "m/s", "velocity over ground in body axes");
    visit("theta", self.theta, "rad", "roll, pitch, heading");
    visit("gyro_bias_B", self.gyro_bias_B, "rad/s", "bias of the gyro");
  }
};

}  // namespace ironbird::autopilot
