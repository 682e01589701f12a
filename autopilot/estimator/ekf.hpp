#pragma once

#include "autopilot/estimator/aided_estimator.hpp"
#include "autopilot/estimator/ekf_process.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {

/// Noise that drives the 12-state filter. Spectral densities: variance per second, or its root.
///
/// With `reference_scaling` every number is used as the reference implementation does: the entries of the
/// state as variances, accelerometer and gyro as standard deviations, and all multiplied by the square of the
/// step.
struct EkfNoiseParams {
  bool reference_scaling = false;
  double position = 0.0;
  double height = 0.0;
  double velocity = 1.0e-3;
  double velocity_down = 1.0e-3;
  double roll_pitch = 1.0e-8;
  double heading = 1.0e-8;
  double gyro_bias = 1.0e-10;
  double accelerometer = 0.02;
  double gyro = 3.0e-4;
  double gyro_per_rate = 0.0;
  double gyro_per_vibration = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("reference_scaling", self.reference_scaling, "1",
          "(Q + G Q_u G^T)(Ts/N)^2 instead of (Q + G Q_u G^T) Ts/N");
    visit("position", self.position, "m^2/s", "north and east, Q entry", 0.0, 1e6);
    visit("height", self.height, "m^2/s", "down, Q entry", 0.0, 1e6);
    visit("velocity", self.velocity, "m^2/s^3", "front and right, Q entry", 0.0, 1e6);
    visit("velocity_down", self.velocity_down, "m^2/s^3", "along Bz, Q entry", 0.0, 1e6);
    visit("roll_pitch", self.roll_pitch, "rad^2/s", "Q entry", 0.0, 1e6);
    visit("heading", self.heading, "rad^2/s", "Q entry", 0.0, 1e6);
    visit("gyro_bias", self.gyro_bias, "rad^2/s^3", "Q entry", 0.0, 1e6);
    visit("accelerometer", self.accelerometer, "m/s^2/sqrt(Hz)", "noise density of the accelerometer", 0.0,
          1e3);
    visit("gyro", self.gyro, "rad/s/sqrt(Hz)", "noise density of the gyro", 0.0, 1e3);
    visit("gyro_per_rate", self.gyro_per_rate, "sqrt(s)",
          "noise density that the gyro has beyond that per rate of turn, for axes askew and wrong in scale",
          0.0, 10.0);
    visit("gyro_per_vibration", self.gyro_per_vibration, "s/m*sqrt(s)",
          "noise density that the gyro has beyond that per vibration felt, for what shaking does to it", 0.0,
          1.0);
  }
};

/// Parameters of Ekf.
struct EkfParams {
  int propagation_steps = 1;
  bool jacobian_at_new_state = false;
  EkfNoiseParams noise;
  AidingParams aiding;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("propagation_steps", self.propagation_steps, "1", "N, steps from one IMU sample to the next", 1.0,
          20.0);
    visit("jacobian_at_new_state", self.jacobian_at_new_state, "1",
          "take A and G after x has been carried forward, as the reference does");
    visit("noise", self.noise, "", "process noise");
    AidingParams::describe(self.aiding, visit);
  }
};

/// The continuous-discrete extended Kalman filter of the ROScopter paper: 12 states, ZYX Euler angles.
///
/// Position in N, velocity in B. Every equation, and where paper, reference code and algebra disagree, is in
/// docs/equations.md. It does not estimate the bias of the accelerometer.
class Ekf : public Tunable<AidedEstimator, EkfParams> {
 public:
  const EkfState& state() const { return x_; }
  const EkfState::Matrix& covariance() const { return P_; }

  void reset() override;

 protected:
  const AidingParams& aiding() const override { return params().aiding; }
  void start(const StartState& start) override;
  void predict(const Vector3& f_B, const Vector3& w_B, double dt) override;
  void correct_mag(const Vector3& m_B, Time now) override;
  void correct_baro(double difference, Time now) override;
  void correct_gnss(const GnssObservation& fix, Time now) override;
  void doubt_heading(double sigma) override;
  Kinematics kinematics() const override;
  bool is_finite() const override;
  void publish(StateEstimate& estimate) const override;
  void probe_filter(ProbeVisitor& visit) const override;

 private:
  EkfStepNoise step_noise(const Vector3& w_B, double h) const;
  void set_attitude(const Vector3& theta);
  void apply(const EkfState::Vector& correction);
  void set_heading(double heading, double variance);
  void fuse_velocity(const GnssObservation& fix, Time now, ScalarUpdate<EkfState::kSize>& update);
  void fuse_position(const GnssObservation& fix, Time now, ScalarUpdate<EkfState::kSize>& update);

  EkfState x_;
  EulerTrig trig_;  ///< of x_.theta, always
  EkfState::Matrix P_ = EkfState::Matrix::Identity();
};

}  // namespace ironbird::autopilot
