#pragma once

#include "autopilot/estimator/aided_estimator.hpp"
#include "autopilot/estimator/error_state_process.hpp"
#include "autopilot/estimator/scalar_update.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {

/// Noise that drives the error-state filter. Densities: root of variance per second.
struct ErrorStateNoiseParams {
  double accelerometer = 0.015;
  double gyro = 2.0e-4;
  double gyro_per_vibration = 0.0;
  double gyro_bias = 1.0e-5;
  double accelerometer_bias = 3.0e-4;
  double gyro_misalignment = 0.01;
  double gyro_scale = 0.01;
  double gnss_horizontal = 1.0;
  double gnss_vertical = 2.0;
  double gnss_time_constant = 400.0;
  double baro = 20.0;
  double baro_time_constant = 600.0;
  double mag = 0.01;
  double mag_time_constant = 1000.0;
  double initial_accelerometer_bias = 0.06;
  double initial_vertical_bias = 0.02;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("accelerometer", self.accelerometer, "m/s^2/sqrt(Hz)", "noise density of the accelerometer", 0.0,
          1e3);
    visit("gyro", self.gyro, "rad/s/sqrt(Hz)", "noise density of the gyro", 0.0, 1e3);
    visit("gyro_per_vibration", self.gyro_per_vibration, "s/m*sqrt(s)",
          "noise density that the gyro has beyond that per vibration felt, for what shaking does to it", 0.0,
          1.0);
    visit("gyro_bias", self.gyro_bias, "rad/s/sqrt(s)", "walk of the gyro bias", 0.0, 1e3);
    visit("accelerometer_bias", self.accelerometer_bias, "m/s^2/sqrt(s)", "walk of the accelerometer bias",
          0.0, 1e3);
    visit("gyro_misalignment", self.gyro_misalignment, "rad", "turn of the gyro's axes, 1 sigma per axis",
          0.0, 1.0);
    visit("gyro_scale", self.gyro_scale, "1", "scale error of each axis of the gyro, 1 sigma", 0.0, 1.0);
    visit("gnss_horizontal", self.gnss_horizontal, "m", "slow error of north and east, 1 sigma at rest", 0.0,
          1e3);
    visit("gnss_vertical", self.gnss_vertical, "m", "slow error of height, 1 sigma at rest", 0.0, 1e3);
    visit("gnss_time_constant", self.gnss_time_constant, "s", "memory of the slow satellite error", 1.0, 1e6);
    visit("baro", self.baro, "Pa", "slow error of the pressure, 1 sigma at rest", 0.0, 1e5);
    visit("baro_time_constant", self.baro_time_constant, "s", "memory of the slow pressure error", 1.0, 1e6);
    visit("mag", self.mag, "1", "slow error of the field's unit vector, per axis, 1 sigma at rest", 0.0, 1.0);
    visit("mag_time_constant", self.mag_time_constant, "s", "memory of the slow compass error", 1.0, 1e6);
    visit("initial_accelerometer_bias", self.initial_accelerometer_bias, "m/s^2",
          "bias of the accelerometer at the start, 1 sigma", 0.0, 10.0);
    visit("initial_vertical_bias", self.initial_vertical_bias, "m/s^2",
          "the part along gravity after alignment at rest, 1 sigma", 0.0, 10.0);
  }
};

/// Parameters of ErrorStateFilter.
struct ErrorStateParams {
  ErrorStateNoiseParams noise;
  AidingParams aiding = default_aiding();

  /// What this filter needs other than the Euler filter: its receiver is white around the walk.
  static AidingParams default_aiding() {
    AidingParams aiding;
    aiding.gnss.sigma_horizontal = 0.3;
    aiding.gnss.sigma_vertical = 0.6;
    return aiding;
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("noise", self.noise, "", "process noise");
    AidingParams::describe(self.aiding, visit);
  }
};

/// Quaternion error-state filter: position and velocity in N, attitude, biases of gyro and accelerometer,
/// misalignment and scale of the gyro, and the slow errors of receiver, barometer and compass as Gauss-Markov
/// states. 28 error components.
///
/// Equations in docs/equations.md, section 9. It does not estimate wind or lever arms.
class ErrorStateFilter : public Tunable<AidedEstimator, ErrorStateParams> {
 public:
  const ErrorState& state() const { return x_; }
  const ErrorState::Matrix& covariance() const { return P_; }

  void reset() override;

 protected:
  const AidingParams& aiding() const override { return params().aiding; }
  void start(const StartState& start) override;
  void predict(const Vector3& f_B, const Vector3& w_B, double dt) override;
  void correct_mag(const Vector3& m_B, Time now) override;
  void correct_baro(double difference, Time now) override;
  void correct_gnss(const GnssObservation& fix, Time now) override;
  void doubt_heading(double sigma) override;
  Kinematics kinematics() const override { return {x_.p_NB_N, x_.v_NB_N}; }
  Vector3 slow_fix_error_N() const override { return x_.gnss_walk_N; }
  bool is_finite() const override;
  void publish(StateEstimate& estimate) const override;
  void probe_filter(ProbeVisitor& visit) const override;

 private:
  using Update = ScalarUpdate<ErrorState::kSize>;

  void rebuild_step_constants(double h);
  void start_at_rest(const Vector3& down_B);
  void start_heading(const Vector3& m_B, const Vector3& down_B);
  void inject(const ErrorState::Vector& correction);
  void fuse_velocity(const GnssObservation& fix, Time now, Update& update);
  void fuse_position(const GnssObservation& fix, Time now, Update& update);
  void on_parameters() override { step_ = 0.0; }

  ErrorState x_;
  ErrorState::Matrix P_ = ErrorState::Matrix::Identity();
  double step_ = 0.0;  ///< s, that the two constants below belong to; 0: none
  WalkDecay decay_;
  ErrorState::Vector noise_ = ErrorState::Vector::Zero();
};

}  // namespace ironbird::autopilot
