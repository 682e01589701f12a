#pragma once

#include <array>
#include <optional>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// Where the filter was a short while ago: position and velocity in N, for measurements that arrive late.
///
/// Corrections that the filter made in the meantime are applied to the past as well, so that one error is
/// never corrected twice: an entry is stored less the sum of all corrections up to it and read with the
/// present sum.
class DelayLine {
 public:
  /// 0.64 s at 400 Hz, 0.51 s at any higher rate.
  static constexpr int kCapacity = 256;
  /// States nearer in time than this to the one before are not kept: a straight line between is good to 5 um.
  static constexpr Time kLeastSpacing = std::chrono::microseconds(2000);

  /// Where the vehicle was and how it moved at some time.
  struct Past {
    Vector3 p_N = Vector3::Zero();  ///< m
    Vector3 v_N = Vector3::Zero();  ///< m/s

    template <class Self, class Visit>
    static void describe(Self& self, Visit&& visit) {
      visit("p_N", self.p_N, "m", "position from the local origin");
      visit("v_N", self.v_N, "m/s", "velocity over ground");
    }
  };

  void clear();

  /// Remembers the state at `stamp`, which is newer than all before, unless it is too near to the newest.
  void push(Time stamp, const Vector3& p_N, const Vector3& v_N);

  /// Tells that the filter was corrected, now, by these amounts.
  void correct(const Vector3& dp_N, const Vector3& dv_N);

  /// The state at `stamp`, interpolated linearly; the newest entry when `stamp` is newer, nothing when it is
  /// older than the oldest entry.
  std::optional<Past> at(Time stamp) const;

 private:
  struct Entry {
    Time stamp{0};
    Vector3 p_N = Vector3::Zero();
    Vector3 v_N = Vector3::Zero();
  };

  /// @param age  0: the newest
  const Entry& entry(int age) const { return entries_[(newest_ + kCapacity - age) % kCapacity]; }

  std::array<Entry, kCapacity> entries_{};
  int newest_ = kCapacity - 1;
  int count_ = 0;
  Vector3 corrected_p_N_ = Vector3::Zero();
  Vector3 corrected_v_N_ = Vector3::Zero();
};

}  // namespace ironbird::autopilot
