#include "hil_bridge/virtual_fcu/attitude_filter.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kInitialGainFactor = 10.0F;
constexpr std::uint64_t kHealthTimeoutUs = 500000;

float low_passed(float alpha, float measured, float previous) {
  return (1.0F - alpha) * measured + alpha * previous;
}

void normalise(AttitudeQ& q) {
  const float scale = 1.0F / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const float sign = q.w < 0.0F ? -scale : scale;
  q.w *= sign;
  q.x *= sign;
  q.y *= sign;
  q.z *= sign;
}

/// Rows of the matrix that takes body components to the world.
struct Rows {
  Triple x;
  Triple y;
  Triple z;
};

Rows rows_of(const AttitudeQ& q) {
  return {
      {1.0F - 2.0F * (q.y * q.y + q.z * q.z), 2.0F * (q.x * q.y - q.w * q.z), 2.0F * (q.x * q.z + q.w * q.y)},
      {2.0F * (q.x * q.y + q.w * q.z), 1.0F - 2.0F * (q.x * q.x + q.z * q.z), 2.0F * (q.y * q.z - q.w * q.x)},
      {2.0F * (q.x * q.z - q.w * q.y), 2.0F * (q.y * q.z + q.w * q.x),
       1.0F - 2.0F * (q.x * q.x + q.y * q.y)}};
}

/// Far from a unit quaternion the correction overflows, and with it the attitude for ever.
bool is_usable(const AttitudeQ& q) {
  constexpr float kGreatestSquaredNorm = 1e6F;
  const float squared_norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return squared_norm < kGreatestSquaredNorm;  // false for a NaN
}

Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

float Attitude::roll() const {
  return std::atan2(2.0F * (q_NB.w * q_NB.x + q_NB.y * q_NB.z),
                    1.0F - 2.0F * (q_NB.x * q_NB.x + q_NB.y * q_NB.y));
}

float Attitude::pitch() const {
  // Rounding takes the sine of a vertical nose just above one.
  return std::asin(std::clamp(2.0F * (q_NB.w * q_NB.y - q_NB.z * q_NB.x), -1.0F, 1.0F));
}

float Attitude::heading() const {
  return std::atan2(2.0F * (q_NB.w * q_NB.z + q_NB.x * q_NB.y),
                    1.0F - 2.0F * (q_NB.y * q_NB.y + q_NB.z * q_NB.z));
}

void AttitudeFilter::configure(const ParameterStore& parameters) {
  accelerometer_lpf_ = parameters.real(parameter("ACC_LPF"));
  gyro_xy_lpf_ = parameters.real(parameter("GYRO_XY_LPF"));
  gyro_z_lpf_ = parameters.real(parameter("GYRO_Z_LPF"));
  accelerometer_gain_ = parameters.real(parameter("FILT_ACC_KP"));
  external_gain_ = parameters.real(parameter("FILT_EXT_KP"));
  bias_gain_ = parameters.real(parameter("FILT_KI"));
  const float margin = parameters.real(parameter("FILT_ACC_MARGIN"));
  least_squared_norm_ = (1.0F - margin) * (1.0F - margin) * kGravity * kGravity;
  greatest_squared_norm_ = (1.0F + margin) * (1.0F + margin) * kGravity * kGravity;
  const std::int32_t initial_ms = parameters.integer(parameter("FILT_INIT_T"));
  fast_until_us_ = initial_ms > 0 ? static_cast<std::uint64_t>(initial_ms) * 1000U : 0U;
  use_accelerometer_ = parameters.on(parameter("FILT_USE_ACC"));
  watch_health_ = use_accelerometer_ && !parameters.on(parameter("FIXED_WING"));
  quadratic_ = parameters.on(parameter("FILT_QUAD_INT"));
  closed_form_ = parameters.on(parameter("FILT_MAT_EXP"));
}

void AttitudeFilter::reset() {
  attitude_ = {};
  bias_ = {};
  acceleration_ = {0.0F, 0.0F, -kGravity};
  rate_ = {};
  rate_before_ = {};
  rate_long_before_ = {};
  external_.reset();
}

void AttitudeFilter::set_external(const AttitudeQ& q_NB) {
  if (is_usable(q_NB)) external_ = q_NB;
}

void AttitudeFilter::step(const ImuInput& imu, float dt) {
  if (!started_) {
    started_ = true;
    last_accelerometer_us_ = imu.stamp_us;
    last_external_us_ = imu.stamp_us;
    return;
  }
  low_pass(imu);
  Correction correction = accelerometer_correction(imu.stamp_us);
  // A step of no length has no weight to give it: it waits for the next one.
  if (external_ && dt > 0.0F) correction = external_correction(imu.stamp_us, dt);
  float bias_gain = bias_gain_;
  if (imu.stamp_us < fast_until_us_) {
    correction.gain = kInitialGainFactor * accelerometer_gain_;
    bias_gain = kInitialGainFactor * bias_gain_;
  }
  const Triple& e = correction.error;
  bias_.x -= bias_gain * e.x * dt;
  bias_.y -= bias_gain * e.y * dt;
  bias_.z -= bias_gain * e.z * dt;
  const Triple smooth = smoothed_rate();
  propagate({smooth.x - bias_.x + correction.gain * e.x, smooth.y - bias_.y + correction.gain * e.y,
             smooth.z - bias_.z + correction.gain * e.z},
            dt);
  attitude_.w_NB_B = {rate_.x - bias_.x, rate_.y - bias_.y, rate_.z - bias_.z};
  unhealthy_ = watch_health_ && imu.stamp_us > last_accelerometer_us_ + kHealthTimeoutUs;
}

void AttitudeFilter::low_pass(const ImuInput& imu) {
  acceleration_.x = low_passed(accelerometer_lpf_, imu.acceleration.x, acceleration_.x);
  acceleration_.y = low_passed(accelerometer_lpf_, imu.acceleration.y, acceleration_.y);
  acceleration_.z = low_passed(accelerometer_lpf_, imu.acceleration.z, acceleration_.z);
  rate_.x = low_passed(gyro_xy_lpf_, imu.angular_velocity.x, rate_.x);
  rate_.y = low_passed(gyro_xy_lpf_, imu.angular_velocity.y, rate_.y);
  rate_.z = low_passed(gyro_z_lpf_, imu.angular_velocity.z, rate_.z);
}

bool AttitudeFilter::accelerometer_usable(float squared_norm) const {
  return use_accelerometer_ && squared_norm > least_squared_norm_ && squared_norm < greatest_squared_norm_;
}

AttitudeFilter::Correction AttitudeFilter::accelerometer_correction(std::uint64_t stamp_us) {
  const Triple& a = acceleration_;
  const float squared_norm = a.x * a.x + a.y * a.y + a.z * a.z;
  if (!accelerometer_usable(squared_norm)) return {};
  const float scale = 1.0F / std::sqrt(squared_norm);
  // q_a turns e = (0, 0, -1) into the direction of a by the shortest way; d = e . a, e x a = (a.y, -a.x, 0).
  const float d = -a.z * scale;
  if (1.0F + d <= 0.0F && !undefined_when_inverted_) {
    ++undefined_tilts_;
    return {};
  }
  last_accelerometer_us_ = stamp_us;
  const float divisor = std::sqrt(2.0F * (1.0F + d));
  const float aw = std::sqrt(0.5F * (1.0F + d));
  const float ax = a.y * scale / divisor;
  const float ay = -a.x * scale / divisor;
  const AttitudeQ& q = attitude_.q_NB;
  const float tilt_w = q.w * aw - q.x * ax - q.y * ay;
  const float tilt_x = q.w * ax + q.x * aw - q.z * ay;
  const float tilt_y = q.w * ay + q.y * aw + q.z * ax;
  return {{-2.0F * tilt_w * tilt_x, -2.0F * tilt_w * tilt_y, 0.0F}, accelerometer_gain_};
}

AttitudeFilter::Correction AttitudeFilter::external_correction(std::uint64_t stamp_us, float dt) {
  const Rows believed = rows_of(attitude_.q_NB);
  const Rows given = rows_of(*external_);
  const Triple ex = cross(given.x, believed.x);
  const Triple ey = cross(given.y, believed.y);
  const Triple ez = cross(given.z, believed.z);
  const float weight = static_cast<float>(stamp_us - last_external_us_) * 1e-6F / dt;
  last_external_us_ = stamp_us;
  external_.reset();
  return {{(ex.x + ey.x + ez.x) * weight, (ex.y + ey.y + ez.y) * weight, (ex.z + ey.z + ez.z) * weight},
          external_gain_};
}

Triple AttitudeFilter::smoothed_rate() {
  if (!quadratic_) return rate_;
  const auto smooth = [](float newest, float before, float long_before) {
    return (-1.0F / 12.0F) * long_before + (8.0F / 12.0F) * before + (5.0F / 12.0F) * newest;
  };
  const Triple result = {smooth(rate_.x, rate_before_.x, rate_long_before_.x),
                         smooth(rate_.y, rate_before_.y, rate_long_before_.y),
                         smooth(rate_.z, rate_before_.z, rate_long_before_.z)};
  rate_long_before_ = rate_before_;
  rate_before_ = rate_;
  return result;
}

void AttitudeFilter::propagate(const Triple& rate, float dt) {
  const float p = rate.x;
  const float q = rate.y;
  const float r = rate.z;
  const float squared_norm = p * p + q * q + r * r;
  if (squared_norm == 0.0F) return;
  AttitudeQ& a = attitude_.q_NB;
  if (closed_form_) {
    const float norm = std::sqrt(squared_norm);
    const float c = std::cos(norm * dt / 2.0F);
    const float s = std::sin(norm * dt / 2.0F) / norm;
    a.w = c * a.w + s * (-p * a.x - q * a.y - r * a.z);
    a.x = c * a.x + s * (p * a.w + r * a.y - q * a.z);
    a.y = c * a.y + s * (q * a.w - r * a.x + p * a.z);
    a.z = c * a.z + s * (r * a.w + q * a.x - p * a.y);
  } else {
    const AttitudeQ rates = {-p * a.x - q * a.y - r * a.z, p * a.w + r * a.y - q * a.z,
                             q * a.w - r * a.x + p * a.z, r * a.w + q * a.x - p * a.y};
    a.w += 0.5F * dt * rates.w;
    a.x += 0.5F * dt * rates.x;
    a.y += 0.5F * dt * rates.y;
    a.z += 0.5F * dt * rates.z;
  }
  normalise(a);
}

}  // namespace ironbird::hil_bridge::virtual_fcu
