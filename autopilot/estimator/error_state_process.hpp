#pragma once

#include "autopilot/estimator/ekf_process.hpp"
#include "autopilot/estimator/error_state.hpp"

namespace ironbird::autopilot {

/// How fast the slow errors forget.
struct WalkDecay {
  double gnss = 1.0;
  double baro = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("gnss", self.gnss, "1", "what is left of the satellite walk after one step");
    visit("baro", self.baro, "1", "what is left of the barometer walk after one step");
  }
};

/// The state one step h (s) later: inertial sensors held, attitude of the middle of the step for the
/// acceleration.
/// @param R_mid  set to R_NB in the middle of the step
ErrorState error_state_propagate(const ErrorState& x, const EkfInput& u, const WalkDecay& decay, double h,
                                 Matrix3& R_mid);

/// The blocks of the error's transition over one step that are neither zero nor multiples of identity. First
/// letter: row, second: column; p, v, t (attitude), g (gyro bias), a (accelerometer bias). The block (p, v)
/// is h times identity, the walks are multiplied by their decay.
struct ErrorTransition {
  Matrix3 pt, pa, vt, vg, va, tt, tg;
  double h = 0.0;
  WalkDecay decay;

  /// The transition as a full matrix.
  ErrorState::Matrix full() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pt", self.pt, "m/rad", "position from attitude");
    visit("pa", self.pa, "s^2", "position from accelerometer bias");
    visit("vt", self.vt, "m/s/rad", "velocity from attitude");
    visit("vg", self.vg, "m/rad", "velocity from gyro bias");
    visit("va", self.va, "s", "velocity from accelerometer bias");
    visit("tt", self.tt, "1", "attitude from attitude");
    visit("tg", self.tg, "s", "attitude from gyro bias");
    visit("h", self.h, "s", "step");
    visit("decay", self.decay, "", "of the walks");
  }
};

/// @param x  state at the beginning of the step, for its biases
ErrorTransition error_transition(const ErrorState& x, const EkfInput& u, const Matrix3& R_mid,
                                 const WalkDecay& decay, double h);

/// P <- F P F^T + diag(noise), by blocks; P is symmetric, and stays so to the last bit.
void error_state_propagate_covariance(ErrorState::Matrix& P, const ErrorTransition& F,
                                      const ErrorState::Vector& noise);

/// The compass's innovation, declination - azimuth of R m, and its derivative with respect to the attitude
/// error.
struct ErrorMagModel {
  double innovation = 0.0;
  Eigen::Matrix<double, 1, 3> H = Eigen::Matrix<double, 1, 3>::Zero();
  double levelness = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("innovation", self.innovation, "rad", "magnetic north less where the field seems to point");
    visit("levelness", self.levelness, "1", "horizontal part of the unit field, squared");
  }
};

/// @param m_B  unit vector along the magnetic field
ErrorMagModel error_state_mag(const ErrorState& x, const Vector3& m_B, double declination);

}  // namespace ironbird::autopilot
