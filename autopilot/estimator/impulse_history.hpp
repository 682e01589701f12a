#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// The time integral of a specific force in axes that do not turn, as a function of time for a second and
/// longer: so that it can be had for the time of a fix, which is told of later. Never allocates.
class ImpulseHistory {
 public:
  /// Begins anew, at 0.
  void begin(Time now) {
    count_ = 0;
    newest_ = {now, Vector3::Zero()};
    keep(newest_);
  }

  /// @param f  m/s^2, of the last `dt` seconds up to `now`
  void add(Time now, const Vector3& f, double dt) {
    newest_ = {now, newest_.impulse + f * dt};
    if (now - kept(0).stamp >= kPeriod) keep(newest_);
  }

  Time newest() const { return newest_.stamp; }
  /// Of what is kept.
  Time oldest() const { return kept(count_ - 1).stamp; }

  /// m/s, linear between what is kept; before and behind it the first and the last value.
  Vector3 at(Time when) const {
    Entry after = newest_;
    if (when >= after.stamp) return after.impulse;
    for (std::size_t back = 0; back < count_; ++back) {
      const Entry& before = kept(back);
      if (before.stamp <= when) {
        const double share = seconds(when - before.stamp) / seconds(after.stamp - before.stamp);
        return before.impulse + share * (after.impulse - before.impulse);
      }
      after = before;
    }
    return after.impulse;
  }

 private:
  struct Entry {
    Time stamp{};
    Vector3 impulse = Vector3::Zero();
  };
  static constexpr Time kPeriod = std::chrono::milliseconds(10);

  void keep(const Entry& entry) {
    head_ = (head_ + 1) % entries_.size();
    entries_[head_] = entry;
    count_ = std::min(count_ + 1, entries_.size());
  }
  const Entry& kept(std::size_t back) const {
    return entries_[(head_ + entries_.size() - back) % entries_.size()];
  }

  std::array<Entry, 128> entries_{};
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  Entry newest_;
};

}  // namespace ironbird::autopilot
