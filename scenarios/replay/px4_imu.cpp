#include "scenarios/replay/px4_imu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "scenarios/config/user_error.hpp"
#include "scenarios/replay/imu_gaps.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

constexpr std::int64_t kInvalidSample = 0x7fffffff;
constexpr Time kLongestGap = std::chrono::seconds(1);  // beyond it a stamp is doubted
constexpr double kLongestLength = 1e6;                 // us, of a sample

class ImuReader {
 public:
  explicit ImuReader(Px4Log& log) : log_(log) {}

  std::vector<hil_bridge::Arrival> read() {
    find_zero();
    imu_ = log_.records("sensor_combined");
    const auto rates = imu_.find("gyro_rad");
    const auto forces = imu_.find("accelerometer_m_s2");
    if (!rates || !forces)
      throw UserError(log_.name + ": its IMU samples have no rates or no specific forces");
    const auto relative = imu_.find("accelerometer_timestamp_relative");
    const auto length = imu_.find("gyro_integral_dt");
    std::size_t invalid = 0;
    for (std::size_t k = 0; k < imu_.size() && !stepped_back_; ++k) {
      if (!is_wanted(k)) continue;
      RecordedImuSample sample;
      sample.stamp = imu_.published(k);
      sample.f_B = imu_.vector(k, forces);
      sample.w_NB_B = imu_.vector(k, rates);
      if (imu_.integer(k, relative) == kInvalidSample) {
        sample.f_B.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      if (!sample.is_finite()) ++invalid;
      // Before 1.7 in seconds.
      const double us = imu_.number(k, length) * (length && length->type == UlogType::kFloat ? 1e6 : 1.0);
      if (us > 0.0 && us < kLongestLength) sample.length = Time(std::llround(1e3 * us));
      samples_.push_back(sample);
      before_ = sample.stamp;
    }
    log_.end = before_.value_or(Time::zero());
    log_.remark_count(doubted_, "samples of the IMU with stamps that the others do not share passed over");
    log_.remark_count(invalid, "samples of the IMU are not valid: the estimators do without them");
    log_.remark_count(fill_gaps(samples_),
                      "samples of the IMU that the log lacks: foretold from those around them");
    std::vector<hil_bridge::Arrival> messages;
    messages.reserve(samples_.size());
    for (const RecordedImuSample& sample : samples_) messages.push_back({sample.stamp, message_of(sample)});
    return messages;
  }

 private:
  /// The first sample that the next one follows.
  void find_zero() {
    const UlogSeries* const series = log_.file.find("sensor_combined");
    const auto stamp = series == nullptr ? std::nullopt : series->find("timestamp");
    if (!stamp || series->size() == 0) {
      throw UserError(
          log_.name +
          ": has no IMU samples (topic sensor_combined); set SDLOG_PROFILE so that they are logged");
    }
    log_.zero = series->integer(0, *stamp);
    imu_ = log_.records("sensor_combined");
    std::size_t first = 0;
    while (first + 1 < imu_.size() && !is_followed(first)) ++first;
    if (first + 1 < imu_.size()) log_.zero = series->integer(first, *stamp);
  }

  /// Does the next sample come soon after this one?
  bool is_followed(std::size_t k) const {
    if (k + 1 >= imu_.size()) return false;
    const Time gap = imu_.published(k + 1) - imu_.published(k);
    return gap > Time::zero() && gap <= kLongestGap;
  }

  bool is_wanted(std::size_t k) {
    const Time when = imu_.published(k);
    const bool goes_on = before_ ? when > *before_ : when >= Time::zero();
    const bool is_start = !before_ && (is_followed(k) || imu_.size() == 1);
    const bool soon = goes_on && (before_ ? when - *before_ <= kLongestGap : is_start);
    const bool has_company = is_followed(k) && is_followed(k + 1);
    if (soon || (goes_on && has_company)) return true;
    if (before_ && !goes_on && has_company && *before_ - when > kLongestGap) {
      char text[128];
      std::snprintf(text, sizeof text,
                    "its clock steps back by %.1f s after %.1f s: what comes later is left out",
                    1e-9 * static_cast<double>((*before_ - when).count()),
                    1e-9 * static_cast<double>(before_->count()));
      log_.remark(text);
      stepped_back_ = true;
      return false;
    }
    ++doubted_;
    return false;
  }

  static rosflight::SmallImu message_of(const RecordedImuSample& sample) {
    const Eigen::Vector3f f = sample.f_B.cast<float>();
    const Eigen::Vector3f w = sample.w_NB_B.cast<float>();
    return {wire_stamp(sample.stamp), f.x(), f.y(), f.z(), w.x(), w.y(), w.z(), 0.0F};
  }

  Px4Log& log_;
  Px4Records imu_;
  std::optional<Time> before_;
  std::vector<RecordedImuSample> samples_;
  std::size_t doubted_ = 0;
  bool stepped_back_ = false;
};

}  // namespace

std::vector<hil_bridge::Arrival> read_px4_imu(Px4Log& log) {
  return ImuReader(log).read();
}

}  // namespace ironbird::scenarios
