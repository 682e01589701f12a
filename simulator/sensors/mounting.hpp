#pragma once

#include <cmath>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Where a sensor sits and which way its axes S point. Readings come in S; with a turn of zero S is parallel
/// to B.
struct MountingParams {
  Vector3 p_BS_B = Vector3::Zero();
  double roll = 0.0;
  double pitch = 0.0;
  double heading = 0.0;

  /// Takes S components to B: heading, then pitch, then roll.
  Matrix3 R_BS() const {
    using AngleAxis = Eigen::AngleAxis<double>;
    return (AngleAxis(heading, Vector3::UnitZ()) * AngleAxis(pitch, Vector3::UnitY()) *
            AngleAxis(roll, Vector3::UnitX()))
        .toRotationMatrix();
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_BS_B", self.p_BS_B, "m", "position from the centre of mass", -10.0, 10.0);
    visit("roll", self.roll, "rad", "of the sensor's axes in B", -3.1415926535897931, 3.1415926535897931);
    visit("pitch", self.pitch, "rad", "of the sensor's axes in B", -1.5707963267948966, 1.5707963267948966);
    visit("heading", self.heading, "rad", "of the sensor's axes in B", -3.1415926535897931,
          3.1415926535897931);
  }
};

}  // namespace ironbird::simulator
