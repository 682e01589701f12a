#pragma once

#include <optional>

#include "autopilot/estimator/aiding_params.hpp"
#include "autopilot/estimator/alignment.hpp"
#include "autopilot/estimator/delay_line.hpp"
#include "autopilot/estimator/estimator.hpp"
#include "autopilot/estimator/fix_trust.hpp"
#include "autopilot/estimator/gate.hpp"
#include "autopilot/estimator/gnss_observation.hpp"
#include "autopilot/estimator/heading_trust.hpp"
#include "autopilot/estimator/vibration_watch.hpp"

namespace ironbird::autopilot {

/// Height from a pressure difference. The air's weight decreases with height as in the standard atmosphere.
struct BaroModel {
  double density = 1.225;
  double density_gradient = 0.0;
  double gravity = 9.81;

  /// p(origin) - p(p_d), Pa: h of the barometer.
  double pressure_difference(double p_d) const {
    return -density * gravity * p_d * (1.0 - 0.5 * density_gradient * p_d);
  }
  /// Derivative of pressure_difference, Pa/m: C of the barometer.
  double slope(double p_d) const { return -density * gravity * (1.0 - density_gradient * p_d); }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("density", self.density, "kg/m^3", "of the air at the origin");
    visit("density_gradient", self.density_gradient, "1/m", "relative change of density with height");
    visit("gravity", self.gravity, "m/s^2", "acceleration of gravity");
  }
};

/// What all inertial filters share: finding the start, the order predict, compass, barometer, satellites,
/// late fixes, silence of sensors, recovery from a state that is not finite, health. A filter supplies the
/// algebra.
class AidedEstimator : public Estimator {
 public:
  void reset() override;
  void probe(ProbeVisitor& visit) const override;

  /// In flight there must be an estimate with an origin to start from; one that was lost is no help, but no
  /// harm.
  std::string objection(const Signals& signals) const override;

  /// Starts from the estimate of the module it replaces, with the age of its position. Height 0 of the
  /// barometer follows from its first sample. After an estimate that was lost it begins as in flight.
  void take_over(const Handover& left) override;

  /// How often the state was not finite and was rebuilt.
  int recoveries() const { return recoveries_; }

  /// How often velocity or heading disagreed so often that the attitude was sought anew.
  int realignments() const { return realignments_; }

 protected:
  /// Position and velocity in N.
  using Kinematics = DelayLine::Past;

  StateEstimate estimate(const SensorFrame& frame, double dt) final;

  virtual const AidingParams& aiding() const = 0;
  /// Sets state and covariance.
  virtual void start(const StartState& start) = 0;
  /// Carries state and covariance over dt, s, > 0, with specific force and gyro held.
  virtual void predict(const Vector3& f_B, const Vector3& w_B, double dt) = 0;
  virtual void correct_mag(const Vector3& m_B, Time now) = 0;
  /// @param difference  pressure at the origin less the measured one, Pa
  virtual void correct_baro(double difference, Time now) = 0;
  virtual void correct_gnss(const GnssObservation& fix, Time now) = 0;
  /// The heading may be wrong by this much more, 1 sigma, rad; the velocity over ground is not.
  virtual void doubt_heading(double sigma) = 0;
  virtual Kinematics kinematics() const = 0;
  /// What the filter knows of the receiver's slow error, m.
  virtual Vector3 slow_fix_error_N() const { return Vector3::Zero(); }
  /// State and variances are numbers.
  virtual bool is_finite() const = 0;
  /// Fills everything but stamp, rates, origin and health.
  virtual void publish(StateEstimate& estimate) const = 0;
  /// Names and values that only this filter has.
  virtual void probe_filter(ProbeVisitor& visit) const = 0;

  /// What the gates said of the last fix, for the judgement of a step.
  /// @param was_off  by how much the velocity was reset, m/s
  void velocity_believed(Time now, double was_off = 0.0);
  void position_believed(Time now) { trust_.position_believed(now); }
  /// Whether the last fixes disagreed with the velocity.
  bool velocity_disputed(Time now) const;
  /// What the height may have walked while a velocity was wrong that is reset now, m. Nothing resets the
  /// height as fixes do the place, so the filter has to doubt it for the barometer to have it back.
  /// @param was_off_down  by how much the velocity down is reset, m/s
  double height_lost(double was_off_down) const;

  /// What to do with a sample of the compass.
  /// @param nis  normalised innovation squared
  Verdict judge_mag(double nis, Time now) {
    return heading_trust_.judge(gates_.mag, nis, aiding().mag, was_armed_, now);
  }

  /// The fixes have disagreed for good. When Doppler says that it is not the filter that has moved, they are
  /// taken back by this much from now on, with doubt; before the first flight with the origin.
  /// @return false: the filter is to believe them
  bool blame_receiver(const Vector3& by_N, Time now);

  /// How much the airframe shakes, m/s^2.
  double vibration() const { return vibration_.rms(); }

  const BaroModel& baro_model() const { return baro_; }
  Gate& position_gate() { return gates_.position; }
  Gate& velocity_gate() { return gates_.velocity; }
  Gate& baro_gate() { return gates_.baro; }
  Gate& mag_gate() { return gates_.mag; }
  /// Innovations of the last update as their gates saw them, for probes.
  struct Innovations {
    Vector3 p_N = Vector3::Zero();  ///< m
    Vector3 v_N = Vector3::Zero();  ///< m/s
    double pressure = 0.0;          ///< Pa
    double heading = 0.0;           ///< rad
  };
  Innovations innovations_;
  /// How far they could have been off and still pass, each in its unit. 0: no gate, or no sample yet.
  Innovations reaches_;

 private:
  struct Gates {
    Gate position;
    Gate velocity;
    Gate baro;
    Gate mag;
  };
  struct Heard {
    Time mag{0};
    Time baro{0};
    Time gnss{0};
  };

  void begin(const StartState& start, Time now);
  void rebuild_baro_model();
  void advance(const ImuSample& imu, double dt);
  void fuse(const SensorFrame& frame);
  void fuse_baro(const BaroSample& baro, Time now);
  void fuse_gnss(const GnssSample& gnss, Time now);
  template <class Correction>
  void tell_delay_line(Correction&& correction);
  void recover(Time now);
  void restart(const StartState& again);
  void realign_if_hopeless(const SensorFrame& frame, double dt);
  void filter_rates(const Vector3& w_B, double dt);
  /// While the fixes are in doubt: this one agrees without the offset. When those of `gnss.persistence` have,
  /// times the number of doubts so far, the offset is dropped.
  bool has_stepped_back(const Vector3& as_told_N, const Vector3& variance, Time now);
  void settle_on_ground();
  /// A heading that was found on the ground has its iron in it.
  void leave_ground();
  void look_after(StateEstimate& estimate, Time now, double dt);
  bool is_lost(const StateEstimate& estimate, Time now) const;
  void seek_attitude();

  Alignment alignment_;
  bool running_ = false;
  bool realigning_ = false;
  bool on_ground_ = false;      // it has started at rest, and was not higher than `mag.ground_height` since
  bool attitude_lost_ = false;  // until the realignment is through
  int seen_resets_ = 0;
  Time last_reset_{0};
  LocalOrigin origin_;
  BaroModel baro_;
  std::optional<double> origin_pressure_;
  Vector3 accelerometer_offset_B_ = Vector3::Zero();
  Vector3 w_filtered_B_ = Vector3::Zero();
  bool rates_known_ = false;
  VibrationWatch vibration_;
  DelayLine delay_line_;
  Gates gates_;
  Heard heard_;
  Time previous_{0};
  std::optional<GnssObservation> last_fix_;
  FixTrust trust_;
  HeadingTrust heading_trust_;
  Vector3 offset_N_ = Vector3::Zero();  // of the fixes, horizontal
  std::optional<Time> back_since_;      // the fixes agree without the offset
  int doubts_ = 0;
  bool was_armed_ = false;
  StateEstimate last_good_;
  int late_fixes_ = 0;
  int recoveries_ = 0;
  int realignments_ = 0;
};

}  // namespace ironbird::autopilot
