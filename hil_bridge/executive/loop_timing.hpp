#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// How often a duration was how long: fixed buckets, ten to a decade from 1 us on, so that adding one costs
/// no memory and p50 and p99 are known to a quarter.
class Histogram {
 public:
  static constexpr std::size_t kBuckets = 62;

  void add(Time duration);

  std::uint64_t count() const { return count_; }
  /// The longest; 0 when there was none.
  Time greatest() const { return Time{greatest_}; }
  /// What this share of all stayed within: the upper bound of a bucket, but never more than the greatest.
  /// @param share  0..1
  Time quantile(double share) const;
  const std::array<std::uint64_t, kBuckets>& counts() const { return counts_; }
  /// Durations of a bucket are at most this; the last bucket has no bound.
  static Time upper_bound(std::size_t bucket);

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("count", self.count_, "1", "durations measured");
    visit("greatest", self.greatest_, "ns", "the longest");
    visit(
        "counts", self.counts_, "1",
        "durations in each bucket: up to 1 us, ten buckets to each decade from there, the last without end");
  }

 private:
  std::uint64_t count_ = 0;
  std::int64_t greatest_ = 0;
  std::array<std::uint64_t, kBuckets> counts_{};
};

/// How the control loop keeps its time.
struct LoopTiming {
  Histogram receive;
  Histogram step;
  Histogram send;
  Histogram response;
  Histogram jitter;
  std::uint64_t passes = 0;
  std::uint64_t missed = 0;
  std::uint64_t most_missed = 0;
  std::uint64_t page_faults = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("receive", self.receive, "", "from waking to all bytes taken, decoded and looked at");
    visit("step", self.step, "", "the autopilot's step");
    visit("send", self.send, "", "the gate's check and writing the command");
    visit("response", self.response, "", "from waking with an IMU frame to its command written");
    visit("jitter", self.jitter, "", "how much later than wanted it woke, when no bytes woke it");
    visit("passes", self.passes, "1", "passes of the loop");
    visit("missed", self.missed, "1", "control periods in which it did not look");
    visit("most_missed", self.most_missed, "1", "of them the most in a row");
    visit("page_faults", self.page_faults, "1", "in its ticks: times that memory had to be waited for");
  }
};

}  // namespace ironbird::hil_bridge
