#include "autopilot/estimator/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "autopilot/math/angles.hpp"
#include "autopilot/math/local_map.hpp"
#include "autopilot/math/standard_atmosphere.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kMostStillForceError = 1.0;  // m/s^2, of |f| - g at rest
constexpr double kMostStillRate = 0.35;       // rad/s, gyro bias plus vibration at rest
constexpr double kMostAmbiguity = 0.5;        // one heading has the field to the north, one to the south
constexpr double kOldestFix = 2.0;            // s: one a second, a second late, is carried on
// How far the stamps of a fix may be ahead of the IMU's: two sources, brought to one clock.
constexpr Time kMostAhead = std::chrono::milliseconds(10);
constexpr double kLeastFence = 2.0;    // Pa, so that a quantised sensor has no outliers
constexpr double kStaleWindow = 10.0;  // durations, on top of what slow sensors need
constexpr double kSlowestFixes = 1.0;  // s, from one fix to the next
constexpr double kSlowestBaro = 0.1;   // s, from one sample to the next

/// s, that a window may last: means over longer are of another time.
double stale_after(const AlignmentParams& wanted) {
  return kStaleWindow * wanted.duration + kSlowestFixes * wanted.fixes + kSlowestBaro * wanted.baro_samples;
}

Vector3 standard_deviation(const Vector3& sum, const Vector3& square_sum, int count) {
  const Vector3 mean = sum / count;
  return (square_sum / count - mean.cwiseProduct(mean)).cwiseMax(0.0).cwiseSqrt();
}

/// The value below which a fraction of the sorted values lies, interpolated.
double quantile(const std::array<double, 512>& sorted, int count, double fraction) {
  const double rank = fraction * (count - 1);
  const int below = static_cast<int>(rank);
  const int above = std::min(below + 1, count - 1);
  return sorted[below] + (rank - below) * (sorted[above] - sorted[below]);
}

}  // namespace

AttitudeFromVectors attitude_from_vectors(const Vector3& f_B, const Vector3& a_N, const Vector3& m_B,
                                          double declination, double gravity) {
  const Vector3 up_N = (a_N - gravity * Vector3::UnitZ()).normalized();  // direction of the specific force
  const Quaternion q_any = Quaternion::FromTwoVectors(f_B, up_N);
  // What is left is a turn by alpha about up_N that brings the field into the plane of magnetic north.
  const Vector3 m_N = q_any * m_B.normalized();
  const Vector3 along = up_N * up_N.dot(m_N);
  const Vector3 across = m_N - along;
  const Vector3 turned = up_N.cross(m_N);
  const Vector3 east_N(-std::sin(declination), std::cos(declination), 0.0);
  const Vector3 north_N(std::cos(declination), std::sin(declination), 0.0);
  const double amplitude = std::hypot(east_N.dot(across), east_N.dot(turned));
  const double phase = std::atan2(east_N.dot(turned), east_N.dot(across));
  // At its clamp no heading is right, and what is nearest to it is taken.
  const double cosine = amplitude > 0.0 ? std::clamp(-east_N.dot(along) / amplitude, -1.0, 1.0) : 0.0;
  const double half_opening = std::acos(cosine);
  const auto northward = [&](double alpha) {
    return north_N.dot(along + across * std::cos(alpha) + turned * std::sin(alpha));
  };
  double alpha = phase + half_opening;
  double best = northward(alpha);
  double other = northward(phase - half_opening);
  if (other > best) {
    std::swap(best, other);
    alpha = phase - half_opening;
  }
  const double both_north = best > 0.0 ? 0.5 * (1.0 + other / best) : 1.0;
  return {(Quaternion(Eigen::AngleAxisd(alpha, up_N)) * q_any).normalized(),
          std::clamp(both_north, std::abs(cosine), 1.0)};
}

double mean_without_outliers(std::array<double, 512>& values, int count) {
  std::sort(values.begin(), values.begin() + count);
  const double first_quartile = quantile(values, count, 0.25);
  const double third_quartile = quantile(values, count, 0.75);
  const double fence = std::max(2.0 * (third_quartile - first_quartile), kLeastFence);
  double sum = 0.0;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (values[i] < first_quartile - fence || values[i] > third_quartile + fence) continue;
    sum += values[i];
    ++kept;
  }
  return sum / kept;
}

void Alignment::reset() {
  window_ = Window{};
  started_ = false;
  armed_ = false;
  imu_calibrated_ = true;
  start_ = StartState{};
}

void Alignment::restart_in_motion() {
  reset();
  armed_ = true;
}

void Alignment::begin_window(Time now) {
  window_ = Window{};
  window_.begin = now;
  window_.impulse.begin(now);
}

void Alignment::add_imu(const ImuSample& imu, double dt) {
  Window& w = window_;
  if (w.imu == 0) {
    w.f_first_B = imu.f_B;
    w.w_first_B = imu.w_NB_B;
  } else {
    const Vector3 turn_B = imu.w_NB_B * dt;
    const double angle = turn_B.norm();
    if (angle > 0.0) w.turned = w.turned * Quaternion(Eigen::AngleAxisd(angle, turn_B / angle));
  }
  ++w.imu;
  // Sums of differences to the first sample: small numbers, no cancellation.
  const Vector3 df_B = imu.f_B - w.f_first_B;
  const Vector3 dw_B = imu.w_NB_B - w.w_first_B;
  w.f_sum_B += df_B;
  w.w_sum_B += dw_B;
  w.f_square_sum_B += df_B.cwiseProduct(df_B);
  w.w_square_sum_B += dw_B.cwiseProduct(dw_B);
  if (imu.stamp > w.begin) w.impulse.add(imu.stamp, w.turned * imu.f_B, dt);
}

void Alignment::add_fix(const GnssSample& fix) {
  Window& w = window_;
  if (w.fixes == 0) w.first_fix = fix;
  ++w.fixes;
  add_told(fix);
  w.latitude_sum += fix.latitude - w.first_fix.latitude;
  w.longitude_sum += shortest_difference(fix.longitude, w.first_fix.longitude);
  w.altitude_sum += fix.altitude - w.first_fix.altitude;
  w.fastest = std::max(w.fastest, fix.v_NB_N.norm());
}

/// A fix whose stamp nobody can place, or that goes back, tells of nothing.
void Alignment::add_told(const GnssSample& fix) {
  Window& w = window_;
  if (fix.stamp < w.impulse.oldest() || fix.stamp > w.impulse.newest() + kMostAhead) return;
  const Vector3 impulse = w.impulse.at(fix.stamp);
  if (!w.told || fix.stamp < w.told_first.stamp) {
    w.told = true;
    w.told_first = fix;
    w.told_first_impulse = impulse;
  }
  w.told_last = fix;
  w.told_last_impulse = impulse;
}

/// How long the time is that the fixes tell of, s.
double Alignment::told_span() const {
  return window_.told ? seconds(window_.told_last.stamp - window_.told_first.stamp) : 0.0;
}

bool Alignment::is_still(const AidingParams& params) const {
  const Window& w = window_;
  const Vector3 f_mean_B = w.f_first_B + w.f_sum_B / w.imu;
  const Vector3 w_mean_B = w.w_first_B + w.w_sum_B / w.imu;
  return standard_deviation(w.f_sum_B, w.f_square_sum_B, w.imu).maxCoeff() < params.alignment.still_force &&
         standard_deviation(w.w_sum_B, w.w_square_sum_B, w.imu).maxCoeff() < params.alignment.still_rate &&
         std::abs(f_mean_B.norm() - params.gravity) < kMostStillForceError &&
         w_mean_B.norm() < kMostStillRate && w.fastest < params.alignment.still_speed;
}

void Alignment::find_at_rest(const AidingParams& params) {
  const Window& w = window_;
  const Vector3 f_mean_B = w.f_first_B + w.f_sum_B / w.imu;
  start_ = StartState{};
  start_.origin.known = true;
  start_.origin.latitude = w.first_fix.latitude + w.latitude_sum / w.fixes;
  start_.origin.longitude = wrap(w.first_fix.longitude + w.longitude_sum / w.fixes);
  start_.origin.altitude = w.first_fix.altitude + w.altitude_sum / w.fixes;
  start_.q_NB =
      attitude_from_vectors(f_mean_B, Vector3::Zero(), w.m_sum_B, params.mag.declination, params.gravity)
          .q_NB;
  start_.m_B = w.m_sum_B.normalized();
  start_.gyro_bias_B = w.w_first_B + w.w_sum_B / w.imu;
  if (params.alignment.remove_accelerometer_offset) {
    start_.accelerometer_offset_B = (f_mean_B.norm() - params.gravity) * f_mean_B.normalized();
  }
  start_.origin_pressure = mean_without_outliers(pressures_, w.baro);
}

bool Alignment::find_in_motion(const AidingParams& params, Time now) {
  const Window& w = window_;
  const double age = std::max(seconds(now - w.told_last.stamp), 0.0);
  if (age > kOldestFix) return false;
  const double span = told_span();
  const Vector3 a_N = (w.told_last.v_NB_N - w.told_first.v_NB_N) / span;
  const Vector3 f_begin = (w.told_last_impulse - w.told_first_impulse) / span;
  const auto [q_N_begin, ambiguity] =
      attitude_from_vectors(f_begin, a_N, w.m_sum_begin, params.mag.declination, params.gravity);
  if (ambiguity > kMostAmbiguity) return false;
  start_ = StartState{};
  start_.moving = true;
  start_.origin.known = true;
  start_.origin.latitude = w.first_fix.latitude;
  start_.origin.longitude = w.first_fix.longitude;
  start_.origin.altitude = w.first_fix.altitude + w.altitude_sum / w.fixes;
  start_.q_NB = q_N_begin * w.turned;
  start_.m_B = w.turned.conjugate() * w.m_sum_begin.normalized();
  const Vector3 since_N = q_N_begin * (w.impulse.at(now) - w.told_last_impulse);
  start_.v_NB_N = w.told_last.v_NB_N + since_N + params.gravity * age * Vector3::UnitZ();
  const Vector2 p_N = local_from_geodetic(w.told_last.latitude, w.told_last.longitude, start_.origin);
  start_.origin_pressure = mean_without_outliers(pressures_, w.baro);
  const double weight = standard_density(start_.origin.altitude) * params.gravity;  // Pa/m
  start_.p_NB_N << p_N + 0.5 * (w.told_last.v_NB_N + start_.v_NB_N).head<2>() * age,
      (w.last_pressure - start_.origin_pressure) / weight;
  return true;
}

void Alignment::collect(const SensorFrame& frame, double dt) {
  if (frame.status) {
    armed_ = frame.status->armed;
    imu_calibrated_ = frame.status->imu_calibrated;
  }
  add_imu(frame.imu, dt);
  if (frame.mag) {
    const Vector3 m_B = frame.mag->m_B.normalized();
    window_.m_sum_B += m_B;
    window_.m_sum_begin += window_.turned * m_B;
    ++window_.mag;
  }
  if (frame.baro) {
    window_.last_pressure = frame.baro->pressure;
    if (window_.baro < static_cast<int>(pressures_.size())) {
      pressures_[window_.baro++] = frame.baro->pressure;
    }
  }
  if (frame.gnss && is_usable(frame.gnss->fix)) add_fix(*frame.gnss);
}

bool Alignment::add(const SensorFrame& frame, double dt, const AidingParams& params) {
  const Time now = frame.imu.stamp;
  // Offsets that are still to be found will step: what is averaged before says nothing about what comes
  // after.
  const bool waits = !imu_calibrated_ && !armed_;
  if (!started_ || waits) {
    started_ = true;
    first_stamp_ = now;
    begin_window(now);
  }
  collect(frame, dt);
  const AlignmentParams& wanted = params.alignment;
  const double length = seconds(now - window_.begin);
  if (length < wanted.duration) return false;
  const bool still = is_still(params);
  const bool may_move = armed_ || seconds(now - first_stamp_) >= wanted.air_start_after;
  const bool complete =
      window_.mag > 0 && window_.fixes >= wanted.fixes && window_.baro >= wanted.baro_samples;
  if (complete && still) {
    find_at_rest(params);
    return true;
  }
  if (complete && may_move && told_span() >= 0.5 * wanted.duration && find_in_motion(params, now))
    return true;
  if ((!still && !may_move) || length > stale_after(wanted)) begin_window(now);
  return false;
}

}  // namespace ironbird::autopilot
