#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "scenarios/replay/arrivals.hpp"
#include "scenarios/replay/ulog_file.hpp"

// What the parts of read_px4_flight share.

namespace ironbird::scenarios {

/// One topic of a log, its fields by name whatever their type, its times since the log's first sample of the
/// IMU.
class Px4Records {
 public:
  Px4Records() = default;
  /// @param series  null: there are no records
  /// @param zero    us since boot
  Px4Records(const UlogSeries* series, std::int64_t zero) : series_(series), zero_(zero) {
    if (series == nullptr) return;
    timestamp_ = series->find("timestamp");
    sampled_ = series->find("timestamp_sample");
    if (!timestamp_) series_ = nullptr;
  }

  std::size_t size() const { return series_ == nullptr ? 0 : series_->size(); }
  std::optional<UlogPlace> find(std::string_view field) const {
    return series_ == nullptr ? std::nullopt : series_->find(field);
  }
  /// The first of these fields that the topic has.
  std::optional<UlogPlace> find_one_of(std::initializer_list<std::string_view> fields) const {
    for (const std::string_view field : fields) {
      if (const auto found = find(field)) return found;
    }
    return std::nullopt;
  }

  /// When record `k` was published.
  hil_bridge::Time published(std::size_t k) const { return since_zero(series_->integer(k, *timestamp_)); }
  /// When what it tells was measured, where that is told.
  hil_bridge::Time measured(std::size_t k) const {
    const std::int64_t sampled = sampled_ ? series_->integer(k, *sampled_) : 0;
    return sampled > 0 ? since_zero(sampled) : published(k);
  }
  /// NaN for a field that there is not.
  double number(std::size_t k, const std::optional<UlogPlace>& place, std::size_t element = 0) const {
    return place && element < place->count ? series_->number(k, *place, element)
                                           : std::numeric_limits<double>::quiet_NaN();
  }
  /// 0 for a field that there is not.
  std::int64_t integer(std::size_t k, const std::optional<UlogPlace>& place) const {
    return place ? series_->integer(k, *place) : 0;
  }
  autopilot::Vector3 vector(std::size_t k, const std::optional<UlogPlace>& place) const {
    return {number(k, place, 0), number(k, place, 1), number(k, place, 2)};
  }

 private:
  hil_bridge::Time since_zero(std::int64_t us) const {
    // Stamps are what the file says: the difference of two of them need not fit.
    const auto difference = static_cast<std::uint64_t>(us) - static_cast<std::uint64_t>(zero_);
    constexpr std::int64_t kLongest = 1'000'000'000'000;  // us, eleven days
    const auto passed = std::clamp<std::int64_t>(static_cast<std::int64_t>(difference), -kLongest, kLongest);
    return std::chrono::microseconds(passed);
  }

  const UlogSeries* series_ = nullptr;
  std::int64_t zero_ = 0;
  std::optional<UlogPlace> timestamp_;
  std::optional<UlogPlace> sampled_;
};

/// A log, from the first sample of its IMU to the last.
class Px4Log {
 public:
  Px4Log(const UlogFile& log, std::string its_name) : file(log), name(std::move(its_name)) {}

  const UlogFile& file;
  std::string name;        ///< in messages
  std::int64_t zero = 0;   ///< us since boot
  hil_bridge::Time end{};  ///< since zero
  std::vector<std::string> remarks;

  void remark(std::string text) { remarks.push_back(std::move(text)); }
  /// Remarks how many there are, when there are some.
  void remark_count(std::size_t count, const std::string& what) {
    if (count > 0) remark(std::to_string(count) + " " + what);
  }
  Px4Records records(std::string_view topic, int instance = 0) const {
    return {file.find(topic, instance), zero};
  }
  /// The first of these topics that was logged.
  Px4Records first_of(std::initializer_list<std::string_view> topics) const {
    for (const std::string_view topic : topics) {
      if (const Px4Records found = records(topic); found.size() > 0) return found;
    }
    return {};
  }
  /// Only what came while the IMU was logged: the last values of before are logged with their old stamps.
  bool is_within(hil_bridge::Time when) const { return when >= hil_bridge::Time::zero() && when <= end; }
};

}  // namespace ironbird::scenarios
