#pragma once

#include <array>
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
  /// @param persistence  after this long without one accepted measurement: reset
  Verdict judge(double nis, double threshold, double persistence, Time now) {
    nis_ = nis;
    if (threshold <= 0.0 || nis <= threshold) {
      disagreeing_ = false;
      return Verdict::kAccept;
    }
    ++rejected_;
    if (!disagreeing_) since_ = now;
    disagreeing_ = true;
    if (seconds(now - since_) < persistence) return Verdict::kReject;
    disagreeing_ = false;
    ++resets_;
    return Verdict::kReset;
  }

  double nis() const { return nis_; }
  bool disagreeing() const { return disagreeing_; }
  int rejected() const { return rejected_; }
  int resets() const { return resets_; }

 private:
  double nis_ = 0.0;
  bool disagreeing_ = false;
  Time since_{0};
  int rejected_ = 0;
  int resets_ = 0;
};

}  // namespace ironbird::autopilot
