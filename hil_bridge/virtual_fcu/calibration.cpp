#include "hil_bridge/virtual_fcu/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kGreatestGyroBias = 1.0F;           // rad/s
constexpr float kGreatestSpread = 1.0F;             // m/s^2
constexpr float kGreatestAccelerometerBias = 3.0F;  // m/s^2
constexpr std::uint32_t kPressurePeriodMs = 20;
constexpr int kPressureSkipped = 128;
constexpr int kPressureUsed = 127;

float norm(const Triple& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace

std::optional<BiasResult> GyroCalibration::add(const Triple& w) {
  sum_ = {sum_.x + w.x, sum_.y + w.y, sum_.z + w.z};
  if (++count_ < kImuCalibrationSamples) return std::nullopt;
  running_ = false;
  const auto n = static_cast<float>(count_);
  BiasResult result{.bias = {sum_.x / n, sum_.y / n, sum_.z / n}};
  result.norm = norm(result.bias);
  if (!(result.norm < kGreatestGyroBias)) result.verdict = BiasResult::Verdict::kMoved;
  return result;
}

std::optional<BiasResult> AccelerometerCalibration::add(const Triple& a, float temperature,
                                                        const Triple& drift) {
  const Triple unloaded = {a.x, a.y, a.z + kGravity};
  if (count_ == 0) least_ = greatest_ = unloaded;
  least_ = {std::min(least_.x, unloaded.x), std::min(least_.y, unloaded.y), std::min(least_.z, unloaded.z)};
  greatest_ = {std::max(greatest_.x, unloaded.x), std::max(greatest_.y, unloaded.y),
               std::max(greatest_.z, unloaded.z)};
  sum_ = {sum_.x + unloaded.x, sum_.y + unloaded.y, sum_.z + unloaded.z};
  temperature_sum_ += temperature;
  if (++count_ < kImuCalibrationSamples) return std::nullopt;
  running_ = false;
  const auto n = static_cast<float>(count_);
  BiasResult result{.bias = {(sum_.x - drift.x * temperature_sum_) / n,
                             (sum_.y - drift.y * temperature_sum_) / n,
                             (sum_.z - drift.z * temperature_sum_) / n}};
  result.norm = norm(result.bias);
  const Triple spread = {greatest_.x - least_.x, greatest_.y - least_.y, greatest_.z - least_.z};
  if (norm(spread) > kGreatestSpread) {
    result.verdict = BiasResult::Verdict::kMoved;
  } else if (!(result.norm < kGreatestAccelerometerBias)) {
    result.verdict = BiasResult::Verdict::kTooLarge;
  }
  return result;
}

void PressureCalibration::start() {
  running_ = true;
  count_ = 0;
  mean_ = 0.0F;
  variance_ = 0.0F;
}

PressureCalibration::Outcome PressureCalibration::add(float pressure, std::uint32_t now_ms) {
  if (now_ms - last_ms_ <= kPressurePeriodMs) return Outcome::kNone;
  last_ms_ = now_ms;
  ++count_;
  if (count_ <= kPressureSkipped) return Outcome::kNone;
  const int used = count_ - kPressureSkipped;
  if (used <= kPressureUsed) {
    const float before = pressure - mean_;
    mean_ += before / static_cast<float>(used);
    variance_ += before * (pressure - mean_) / static_cast<float>(kPressureUsed - 1);
    return Outcome::kNone;
  }
  if (variance_ < greatest_variance_) {
    running_ = false;
    return Outcome::kDone;
  }
  start();
  return Outcome::kUnsteady;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
