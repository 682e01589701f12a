#pragma once

#include "autopilot/estimator/aiding_params.hpp"
#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/sensor_frame.hpp"

namespace ironbird::autopilot {

/// A satellite fix in N, with the state that it is to be compared with.
struct GnssObservation {
  Vector3 p_N = Vector3::Zero();
  Vector3 v_N = Vector3::Zero();
  Vector3 dp_N = Vector3::Zero();
  Vector3 dv_N = Vector3::Zero();
  Vector3 variance_p = Vector3::Ones();
  Vector3 variance_v = Vector3::Ones();
  Vector3 gate_variance_p = Vector3::Ones();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "measured position, carried to the present");
    visit("v_N", self.v_N, "m/s", "measured velocity, carried to the present");
    visit("dp_N", self.dp_N, "m", "measured less predicted position, at the time of the fix");
    visit("dv_N", self.dv_N, "m/s", "measured less predicted velocity, at the time of the fix");
    visit("variance_p", self.variance_p, "m^2", "R of the position");
    visit("variance_v", self.variance_v, "m^2/s^2", "R of the velocity");
    visit("gate_variance_p", self.gate_variance_p, "m^2", "what the gate takes for R of the position");
  }
};

/// Fills the variances.
void weigh(GnssObservation& fix, const GnssSample& gnss, const GnssParams& wanted);

}  // namespace ironbird::autopilot
