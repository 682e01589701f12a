#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <string>

#include "simulator/types/time.hpp"

namespace ironbird::simulator {

/// A rate written by hand, for example 133.333 Hz, means the period it rounds to. Of the period.
constexpr double kRateTolerance = 1e-5;

/// The exact period of a sensor. @param rate  Hz, > 0 @param tick  of the simulation, > 0
/// @throws std::invalid_argument when the period is not a whole number of ticks; the message names `path` and
/// the two nearest rates that are
Time sample_period(double rate, Time tick, const std::string& path);

/// The whole number of ticks nearest to `latency`, as a time. @param latency  s, >= 0
Time whole_ticks(double latency, Time tick);

/// Says when a sensor samples: at every multiple of its period, zero excepted.
class SampleClock {
 public:
  explicit SampleClock(Time period) : period_(period), next_(period) {}

  /// True once for each sample. @param now  never earlier than before
  bool due(Time now) {
    if (now < next_) return false;
    while (next_ <= now) next_ += period_;
    return true;
  }

 private:
  Time period_;
  Time next_;
};

/// Holds readings until their latency is over. First in, first out; of fixed size.
template <class Reading>
class DelayLine {
 public:
  /// The most readings that can be on their way at once.
  static constexpr std::size_t kCapacity = 32;

  /// @param due  not earlier than that of the reading before
  void push(Time due, const Reading& reading) {
    assert(count_ < kCapacity);
    slots_[(first_ + count_) % kCapacity] = {due, reading};
    ++count_;
  }

  /// Moves the readings due by `now` to `out`, where the last one stays.
  void pop(Time now, std::optional<Reading>& out) {
    while (count_ > 0 && slots_[first_].due <= now) {
      out = slots_[first_].reading;
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
  }

 private:
  struct Slot {
    Time due{};
    Reading reading;
  };

  std::array<Slot, kCapacity> slots_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace ironbird::simulator
