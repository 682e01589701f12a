#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// What to do with a measurement.
enum class Verdict : std::uint8_t {
  kAccept,
  kReject,  ///< disagrees too much with the filter
  kReset    ///< has disagreed for so long that the filter must be wrong
};

constexpr std::array<std::pair<Verdict, std::string_view>, 3> enumerators(Verdict) {
  return {{{Verdict::kAccept, "accept"}, {Verdict::kReject, "reject"}, {Verdict::kReset, "reset"}}};
}

/// Judges the measurements of one sensor by their normalised innovation squared, nu^T S^-1 nu, which is
/// chi-square distributed as long as the filter is right.
class Gate {
 public:
  /// @param nis  normalised innovation squared
  /// @param threshold  greatest that is accepted; 0: accept everything
  /// @param persistence  after this long without one accepted measurement, and at least three refused: reset.
  /// After three times as long without a measurement it counts anew: two faults far apart are two faults.
  Verdict judge(double nis, double threshold, double persistence, Time now) {
    nis_ = nis;
    if (threshold <= 0.0 || nis <= threshold) {
      disagreeing_ = false;
      return Verdict::kAccept;
    }
    ++rejected_;
    const bool long_ago = persistence > 0.0 && seconds(now - last_) > kSilence * persistence;
    if (!disagreeing_ || long_ago) {
      since_ = now;
      in_a_row_ = 0;
    }
    disagreeing_ = true;
    last_ = now;
    ++in_a_row_;
    if (in_a_row_ < kLeastInARow || seconds(now - since_) < persistence) return Verdict::kReject;
    disagreeing_ = false;
    ++resets_;
    return Verdict::kReset;
  }

  /// What was refused before counts no more.
  void restart() { disagreeing_ = false; }

  /// How far a measurement of this variance may be off along one axis at the most, in its own unit, and still
  /// pass: the reach of the ellipse within which those of several axes are accepted. 0: no gate.
  static double reach(double variance, double threshold) {
    return threshold > 0.0 ? std::sqrt(threshold * variance) : 0.0;
  }

  double nis() const { return nis_; }
  bool disagreeing() const { return disagreeing_; }
  /// Whether it disagrees and the last refusal is at most this long ago, s.
  bool disagreed_within(double duration, Time now) const {
    return disagreeing_ && seconds(now - last_) <= duration;
  }
  int rejected() const { return rejected_; }
  int resets() const { return resets_; }

 private:
  static constexpr int kLeastInARow = 3;
  static constexpr double kSilence = 3.0;  // persistences

  double nis_ = 0.0;
  bool disagreeing_ = false;
  int in_a_row_ = 0;
  Time since_{0};
  Time last_{0};
  int rejected_ = 0;
  int resets_ = 0;
};

}  // namespace ironbird::autopilot
