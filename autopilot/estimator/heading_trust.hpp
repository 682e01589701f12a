#pragma once

#include <limits>
#include <utility>

#include "autopilot/estimator/aiding_params.hpp"
#include "autopilot/estimator/gate.hpp"

namespace ironbird::autopilot {

/// When compass and filter disagree for good, tells which of them is to blame. A heading that a compass has
/// agreed with is carried on by gyro and Doppler, so a compass that steps away from it in flight is wrong
/// itself. It may set the heading only where that is in doubt.
class HeadingTrust {
 public:
  /// The heading was sought anew, or Doppler has contradicted the filter for good.
  void doubt() {
    proven_ = false;
    counts_anew_ = true;
  }

  /// What to do with a sample of the compass.
  /// @param nis  normalised innovation squared
  /// @param flown  was armed; before, who carries the vehicle past iron gets the compass's heading
  Verdict judge(Gate& gate, double nis, const MagParams& wanted, bool flown, Time now) {
    if (std::exchange(counts_anew_, false)) gate.restart();
    constexpr double kForever = std::numeric_limits<double>::infinity();
    const double persistence = flown && proven_ ? kForever : wanted.persistence;
    const Verdict verdict = gate.judge(nis, wanted.gate, persistence, now);
    if (verdict == Verdict::kAccept) proven_ = true;
    return verdict;
  }

 private:
  bool proven_ = false;       // a compass has agreed with it
  bool counts_anew_ = false;  // what was refused while it was proven is no sign against it
};

}  // namespace ironbird::autopilot
