#pragma once

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Pose and twist of the vehicle's body frame B, whose origin is the centre of mass.
struct RigidBodyState {
  Vector3 p_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 v_NB_N = Vector3::Zero();
  Vector3 w_NB_B = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_NB_N", self.p_NB_N, "m", "position of the centre of mass from the local origin");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity of the centre of mass");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
  }
};

}  // namespace ironbird::simulator
