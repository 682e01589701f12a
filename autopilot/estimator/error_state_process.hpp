#pragma once

#include "autopilot/estimator/ekf_process.hpp"
#include "autopilot/estimator/error_state.hpp"

namespace ironbird::autopilot {

/// How fast the slow errors forget.
struct WalkDecay {
  double gnss = 1.0;
  double baro = 1.0;
  double mag = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("gnss", self.gnss, "1", "what is left of the satellite walk after one step");
    visit("baro", self.baro, "1", "what is left of the barometer walk after one step");
    visit("mag", self.mag, "1", "what is left of the compass bias after one step");
  }
};

/// The angular velocity that the state makes of the gyro's reading, rad/s.
Vector3 corrected_rate(const ErrorState& x, const Vector3& w_NB_B);

/// The state one step h (s) later: inertial sensors held, attitude of the middle of the step for the
/// acceleration.
/// @param R_mid  set to R_NB in the middle of the step
ErrorState error_state_propagate(const ErrorState& x, const EkfInput& u, const WalkDecay& decay, double h,
                                 Matrix3& R_mid);

/// The blocks of the error's transition over one step that are neither zero nor multiples of identity. First
/// letter: row, second: column; p, v, t (attitude), g (gyro bias, misalignment, scale), a (accelerometer
/// bias). The block (p, v) is h times identity, the walks are multiplied by their decay.
struct ErrorTransition {
  using GyroBlock = Eigen::Matrix<double, 3, 9>;

  Matrix3 pt, pa, vt, va, tt;
  GyroBlock vg, tg;
  double h = 0.0;
  WalkDecay decay;

  /// The transition as a full matrix.
  ErrorState::Matrix full() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pt", self.pt, "m/rad", "position from attitude");
    visit("pa", self.pa, "s^2", "position from accelerometer bias");
    visit("vt", self.vt, "m/s/rad", "velocity from attitude");
    visit("vg", self.vg, "", "velocity from gyro bias (m/rad), misalignment (m/s/rad), scale (m/s)");
    visit("va", self.va, "s", "velocity from accelerometer bias");
    visit("tt", self.tt, "1", "attitude from attitude");
    visit("tg", self.tg, "", "attitude from gyro bias (s), misalignment (1), scale (rad)");
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

/// The compass's innovation, declination - azimuth of R (m - bias), and its derivatives with respect to the
/// errors of attitude and bias.
struct ErrorMagModel {
  double innovation = 0.0;
  Eigen::Matrix<double, 1, 3> H_attitude = Eigen::Matrix<double, 1, 3>::Zero();
  Eigen::Matrix<double, 1, 3> H_bias = Eigen::Matrix<double, 1, 3>::Zero();
  double levelness = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("innovation", self.innovation, "rad", "magnetic north less where the field seems to point");
    visit("levelness", self.levelness, "1", "horizontal part of the unit field, squared");
  }
};

/// @param m_B  the measured unit vector along the magnetic field, less the bias of `x`
ErrorMagModel error_state_mag(const ErrorState& x, const Vector3& m_B, double declination);

/// Derivative of v_B with respect to the errors of velocity and attitude, which are neighbours.
/// @param v_NB_B  R^T v_N, m/s
Eigen::Matrix<double, 3, 6> error_body_velocity(const Matrix3& R_NB, const Vector3& v_NB_B);

/// The error of an attitude that was turned by `turn`, from its error before: derivative of
/// Log(Exp(-turn) Exp(e)) at e = turn, without terms of the second order in `turn`.
/// @param turn  rad
Matrix3 error_after_turn(const Vector3& turn);

/// What a bias of the accelerometer, m/s^2, does to the tilt that was found from it at rest: error of the
/// attitude, rad. Nothing about `down_B`, which is the unit vector down.
Matrix3 tilt_from_accelerometer_bias(const Vector3& down_B, double gravity);

/// What is wrong with an attitude whose heading was found with the compass.
struct HeadingStart {
  Matrix3 from_tilt = Matrix3::Identity();
  Matrix3 from_bias = Matrix3::Zero();

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("from_tilt", self.from_tilt, "1", "error of the attitude from the error of the tilt");
    visit("from_bias", self.from_bias, "rad", "error of the attitude from the bias of the unit field");
  }
};

/// @param m_B  unit vector along the measured field
/// @param down_B  unit vector down
HeadingStart heading_start(const ErrorState& x, const Vector3& m_B, const Vector3& down_B,
                           double declination);

}  // namespace ironbird::autopilot
