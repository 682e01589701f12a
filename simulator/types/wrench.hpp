#pragma once

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Force and torque about the centre of mass, in body axes, gravity not included.
struct Wrench {
  Vector3 F_Bcm_B = Vector3::Zero();
  Vector3 M_Bcm_B = Vector3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("F_Bcm_B", self.F_Bcm_B, "N", "force, gravity not included");
    visit("M_Bcm_B", self.M_Bcm_B, "N*m", "torque about the centre of mass");
  }
};

}  // namespace ironbird::simulator
