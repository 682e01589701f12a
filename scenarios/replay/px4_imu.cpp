#include "scenarios/replay/px4_imu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Vector3;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

constexpr std::int64_t kInvalidSample = 0x7fffffff;
constexpr Time kLongestGap = std::chrono::seconds(1);  // beyond it a stamp is doubted

/// One sample: means over the time before it.
struct Sample {
  Time when{};
  Vector3 force = Vector3::Zero();
  Vector3 rate = Vector3::Zero();
  bool is_finite() const { return force.allFinite() && rate.allFinite(); }
};

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
    std::size_t bridged = 0;
    for (std::size_t k = 0; k < imu_.size() && !stepped_back_; ++k) {
      if (!is_wanted(k)) continue;
      Sample sample{imu_.published(k), imu_.vector(k, forces), imu_.vector(k, rates)};
      if (imu_.integer(k, relative) == kInvalidSample) {
        sample.force.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      if (!sample.is_finite()) ++invalid;
      // Before 1.7 in seconds.
      const double us = imu_.number(k, length) * (length && length->type == UlogType::kFloat ? 1e6 : 1.0);
      if (before_ && us > 0.0) bridged += bridge(sample, 1e3 * us);
      add(sample);
      before_ = sample;
    }
    log_.end = before_ ? before_->when : Time::zero();
    log_.remark_count(doubted_, "samples of the IMU with stamps that the others do not share passed over");
    log_.remark_count(invalid, "samples of the IMU are not valid: the estimators do without them");
    log_.remark_count(bridged, "samples of the IMU that the log lacks taken from their neighbours");
    return std::move(messages_);
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
    const bool goes_on = before_ ? when > before_->when : when >= Time::zero();
    const bool is_start = !before_ && (is_followed(k) || imu_.size() == 1);
    const bool soon = goes_on && (before_ ? when - before_->when <= kLongestGap : is_start);
    const bool has_company = is_followed(k) && is_followed(k + 1);
    if (soon || (goes_on && has_company)) return true;
    if (before_ && !goes_on && has_company && before_->when - when > kLongestGap) {
      char text[128];
      std::snprintf(text, sizeof text,
                    "its clock steps back by %.1f s after %.1f s: what comes later is left out",
                    1e-9 * static_cast<double>((before_->when - when).count()),
                    1e-9 * static_cast<double>(before_->when.count()));
      log_.remark(text);
      stepped_back_ = true;
      return false;
    }
    ++doubted_;
    return false;
  }

  void add(const Sample& sample) {
    const Eigen::Vector3f f = sample.force.cast<float>();
    const Eigen::Vector3f w = sample.rate.cast<float>();
    messages_.push_back({sample.when, rosflight::SmallImu{wire_stamp(sample.when), f.x(), f.y(), f.z(), w.x(),
                                                          w.y(), w.z(), 0.0F}});
  }

  /// @param length  over which a sample is the mean, ns. @return how many samples were put in before `after`
  std::size_t bridge(const Sample& after, double length) {
    constexpr double kMost = 5.0;  // samples: a longer gap is a gap
    const double gap = static_cast<double>((after.when - before_->when).count()) - length;
    const double missing = std::round(gap / length);
    if (!(missing >= 1.0 && missing <= kMost) || !before_->is_finite() || !after.is_finite()) return 0;
    for (double k = 1.0; k <= missing; ++k) {
      const double share = k / (missing + 1.0);
      add({before_->when + Time(std::llround(gap * k / missing)),
           before_->force + share * (after.force - before_->force),
           before_->rate + share * (after.rate - before_->rate)});
    }
    return static_cast<std::size_t>(missing);
  }

  Px4Log& log_;
  Px4Records imu_;
  std::optional<Sample> before_;
  std::vector<hil_bridge::Arrival> messages_;
  std::size_t doubted_ = 0;
  bool stepped_back_ = false;
};

}  // namespace

std::vector<hil_bridge::Arrival> read_px4_imu(Px4Log& log) {
  return ImuReader(log).read();
}

}  // namespace ironbird::scenarios
