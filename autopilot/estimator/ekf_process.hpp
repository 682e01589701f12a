#pragma once

#include "autopilot/estimator/ekf_state.hpp"
#include "autopilot/math/euler_zyx.hpp"

namespace ironbird::autopilot {

// The process model of the 12-state filter. ROScopter paper, eqs. 2 to 5; every block in docs/equations.md.
// All functions take the trigonometry of the state's Theta, so that it is computed once.

/// What drives the process: the inertial sensors.
struct EkfInput {
  Vector3 f_B = Vector3::Zero();
  Vector3 w_NB_B = Vector3::Zero();
  double gravity = 9.81;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("f_B", self.f_B, "m/s^2", "specific force, as measured");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity, as measured: bias included");
    visit("gravity", self.gravity, "m/s^2", "acceleration of gravity");
  }
};

/// f(x, u) = x_dot.
EkfState::Vector ekf_dynamics(const EkfState& x, const EulerTrig& at, const EkfInput& u);

/// The blocks of A = df/dx that are not zero. First letter: row, second: column; p, v, t (Theta), b.
struct EkfJacobian {
  Matrix3 pv, pt, vv, vt, vb, tt, tb;

  /// A as a full matrix.
  EkfState::Matrix full() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pv", self.pv, "1", "d p_dot / d v = R");
    visit("pt", self.pt, "m/s/rad", "d p_dot / d Theta");
    visit("vv", self.vv, "1/s", "d v_dot / d v = -[w]x");
    visit("vt", self.vt, "m/s^2/rad", "d v_dot / d Theta");
    visit("vb", self.vb, "m/s/rad", "d v_dot / d b = -[v]x");
    visit("tt", self.tt, "1/s", "d Theta_dot / d Theta");
    visit("tb", self.tb, "1", "d Theta_dot / d b = -S");
  }
};

EkfJacobian ekf_jacobian(const EkfState& x, const EulerTrig& at, const EkfInput& u);

/// G = df/d(noise of accelerometer, noise of gyro), where a sensor reads its true value plus noise.
Eigen::Matrix<double, EkfState::kSize, 6> ekf_noise_jacobian(const EkfState& x, const EulerTrig& at);

/// The blocks of I + A h + A^2 h^2/2 that are neither zero nor identity.
struct EkfTransition {
  Matrix3 pv, pt, pb, vv, vt, vb, tt, tb;

  /// The transition as a full matrix.
  EkfState::Matrix full() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pv", self.pv, "s", "position from velocity");
    visit("pt", self.pt, "m/rad", "position from Theta");
    visit("pb", self.pb, "m*s/rad", "position from gyro bias");
    visit("vv", self.vv, "1", "velocity from velocity");
    visit("vt", self.vt, "m/s/rad", "velocity from Theta");
    visit("vb", self.vb, "m/rad", "velocity from gyro bias");
    visit("tt", self.tt, "1", "Theta from Theta");
    visit("tb", self.tb, "s", "Theta from gyro bias");
  }
};

/// @param h  step, s
EkfTransition ekf_transition(const EkfJacobian& A, double h);

/// P <- F P F^T, by the blocks of F; P is symmetric, and stays so to the last bit.
void ekf_propagate_covariance(EkfState::Matrix& P, const EkfTransition& F);

/// Noise of the process over one step.
struct EkfStepNoise {
  EkfState::Vector direct = EkfState::Vector::Zero();  ///< diagonal of Q times the step
  double accelerometer = 0.0;  ///< variance of the accelerometer's noise times the step
  double gyro = 0.0;           ///< the same for the gyro

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("accelerometer", self.accelerometer, "m^2/s^2", "variance added to the velocity");
    visit("gyro", self.gyro, "rad^2", "variance added to the attitude");
  }
};

/// P <- P + Q + G Q_u G^T, with the blocks of G that are not zero.
void ekf_add_noise(EkfState::Matrix& P, const EkfState& x, const EulerTrig& at, const EkfStepNoise& noise);

}  // namespace ironbird::autopilot
