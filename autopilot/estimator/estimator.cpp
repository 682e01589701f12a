#include "autopilot/estimator/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "autopilot/handover.hpp"

namespace ironbird::autopilot {

namespace {

// Beyond these a sample is a transmission fault, not a measurement.
constexpr double kMostSpecificForce = 1.0e3;  // m/s^2, 100 g
constexpr double kMostRate = 1.0e2;           // rad/s, 16 turns per second
constexpr double kMostField = 1.0e9;          // whatever the unit
constexpr double kMostSpeed = 1.0e3;          // m/s
constexpr double kMostDistance = 1.0e6;       // m
constexpr double kLeastPressure = 1.0e3;      // Pa
constexpr double kMostPressure = 2.0e5;       // Pa

constexpr Time kLongestHold = std::chrono::milliseconds(200);  // of an IMU sample, in place of unsound ones
constexpr double kCalming = 0.02;                              // s, over which vibration is averaged away
constexpr double kRateDies = 0.05;                             // s, of an attitude loop
constexpr Time kFixesAnew = std::chrono::seconds(1);           // so far back only when the receiver restarts

/// Every component is a number within +-limit. False for NaN.
bool is_within(const Vector3& v, double limit) {
  return std::abs(v.x()) <= limit && std::abs(v.y()) <= limit && std::abs(v.z()) <= limit;
}

bool is_sound(const ImuSample& s) {
  return is_within(s.f_B, kMostSpecificForce) && is_within(s.w_NB_B, kMostRate);
}

bool is_sound(const MagSample& s) {
  return is_within(s.m_B, kMostField) && s.m_B.squaredNorm() > 0.0;
}

bool is_sound(const BaroSample& s) {
  return s.pressure >= kLeastPressure && s.pressure <= kMostPressure && std::isfinite(s.temperature);
}

bool is_sound(const GnssSample& s) {
  return std::abs(s.latitude) < 0.5 * std::numbers::pi && std::abs(s.longitude) <= std::numbers::pi &&
         std::abs(s.altitude) <= kMostDistance && is_within(s.v_NB_N, kMostSpeed) &&
         std::isfinite(s.horizontal_accuracy) && std::isfinite(s.vertical_accuracy) &&
         std::isfinite(s.speed_accuracy);
}

bool is_sound(const ExternalPose& s) {
  return is_within(s.p_NB_N, kMostDistance) && is_within(s.v_NB_N, kMostSpeed) &&
         std::abs(s.q_NB.norm() - 1.0) < 0.1;
}

/// Replaces `kept` by the newer sample when it is sound. @return 1 when a sample was dropped
template <class Sample>
int keep_if_sound(const std::optional<Sample>& newer, std::optional<Sample>& kept) {
  if (!newer) return 0;
  if (!is_sound(*newer)) return 1;
  kept = newer;
  return 0;
}

bool is_finite(const StateEstimate& e) {
  return e.p_NB_N.allFinite() && e.v_NB_B.allFinite() && e.q_NB.coeffs().allFinite() &&
         std::isfinite(e.roll) && std::isfinite(e.pitch) && std::isfinite(e.heading) &&
         e.w_NB_B.allFinite() && e.gyro_bias_B.allFinite() && e.accelerometer_bias_B.allFinite() &&
         e.sigma_p_N.allFinite() && e.sigma_v_B.allFinite() && e.sigma_attitude.allFinite();
}

/// Adds `shift` to the stamps of all samples.
void shift_stamps(SensorFrame& frame, Time shift) {
  frame.imu.stamp += shift;
  if (frame.mag) frame.mag->stamp += shift;
  if (frame.baro) frame.baro->stamp += shift;
  if (frame.gnss) frame.gnss->stamp += shift;
  if (frame.external_pose) frame.external_pose->stamp += shift;
}

}  // namespace

int Estimator::keep_new_fix(const std::optional<GnssSample>& newer) {
  // The same fix twice is no second measurement.
  if (newer && newest_fix_ && newer->stamp <= *newest_fix_ && *newest_fix_ - newer->stamp < kFixesAnew)
    return 1;
  const int dropped = keep_if_sound(newer, vetted_.gnss);
  if (newer && dropped == 0) newest_fix_ = newer->stamp;
  return dropped;
}

void Estimator::collect(SensorFrame frame, Time now) {
  shift_stamps(frame, now - frame.imu.stamp);
  vetted_.imu.stamp = now;
  if (is_sound(frame.imu)) {
    f_sum_B_ += frame.imu.f_B;
    w_sum_B_ += frame.imu.w_NB_B;
    ++imu_count_;
    imu_was_away_ = imu_was_away_ || (imu_known_ && now - imu_heard_ > FrameClock::kLongestGap);
    imu_known_ = true;
    imu_heard_ = now;
  } else {
    ++dropped_samples_;
    imu_held_ = true;
  }
  dropped_samples_ += keep_if_sound(frame.mag, vetted_.mag);
  dropped_samples_ += keep_if_sound(frame.baro, vetted_.baro);
  dropped_samples_ += keep_new_fix(frame.gnss);
  dropped_samples_ += keep_if_sound(frame.external_pose, vetted_.external_pose);
  if (frame.status) vetted_.status = frame.status;
}

void Estimator::lose() {
  if (last_.health == Health::kUninitialised) return;
  last_.health = Health::kLost;
  // Nothing follows how it turns.
  last_.w_NB_B.setZero();
  last_.sigma_attitude.setConstant(std::numbers::pi);
}

const StateEstimate& Estimator::run(const SensorFrame& frame) {
  if (!clock_.admits(frame.imu.stamp)) {
    ++refused_frames_;
    if (clock_.lost()) lose();
    return last_;
  }
  const Time now = frame.imu.stamp + clock_.shift();
  collect(frame, now);
  if (!imu_known_) return last_;
  if (now - imu_heard_ > kLongestHold) {
    // No work: to the filter it is a gap, which it knows how to cross.
    lose();
    last_.stamp = now;
    return last_;
  }
  double dt = 0.0;
  if (!divider_.due(now, period(), dt)) return last_;

  merge_imu(dt);
  StateEstimate fresh = estimate(vetted_, dt);
  if (is_finite(fresh)) {
    watch_.observe(fresh);
    last_ = fresh;
    if (imu_held_ && last_.health == Health::kGood) last_.health = Health::kDegraded;
  } else {
    ++non_finite_estimates_;
    lose();
    last_.stamp = now;
  }
  forget_samples();
  return last_;
}

void Estimator::merge_imu(double dt) {
  ImuSample& imu = vetted_.imu;
  if (imu_count_ == 0) {
    // A rate that is only held is fed back as if nothing were done about it, and tips the vehicle.
    w_calm_B_ *= std::max(0.0, 1.0 - dt / kRateDies);
    imu.f_B = f_calm_B_;
    imu.w_NB_B = w_calm_B_;
    return;
  }
  imu.f_B = f_sum_B_ / imu_count_;
  imu.w_NB_B = w_sum_B_ / imu_count_;
  const double kept = dt > 0.0 ? std::max(0.0, 1.0 - dt / kCalming) : 0.0;
  f_calm_B_ = kept * f_calm_B_ + (1.0 - kept) * imu.f_B;
  w_calm_B_ = kept * w_calm_B_ + (1.0 - kept) * imu.w_NB_B;
}

void Estimator::forget_samples() {
  const ImuSample held = vetted_.imu;
  vetted_ = SensorFrame{};
  vetted_.imu = held;
  f_sum_B_.setZero();
  w_sum_B_.setZero();
  imu_count_ = 0;
  imu_held_ = false;
  imu_was_away_ = false;
}

void Estimator::take_over(const Handover& left) {
  watch_.go_on_from(left.estimate);
}

void Estimator::reset() {
  last_ = StateEstimate{};
  forget_samples();
  vetted_ = SensorFrame{};
  f_calm_B_.setZero();
  w_calm_B_.setZero();
  imu_known_ = false;
  imu_heard_ = Time{0};
  newest_fix_.reset();
  divider_.reset();
  clock_ = FrameClock{};
  watch_ = PositionWatch{};
  refused_frames_ = 0;
  dropped_samples_ = 0;
  non_finite_estimates_ = 0;
}

}  // namespace ironbird::autopilot
