#pragma once

#include <cmath>

#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// Feels the ground during a descent: little lift is asked for, and yet nothing moves down, for a while.
class TouchDown {
 public:
  /// @param lift      share of the weight that the last command lifts, 1
  /// @param v_down    m/s
  /// @param slow      vertical speed below which nothing moves, m/s
  /// @param light     lift below which the vehicle ought to fall or sink, 1
  /// @param patience  how long that must last, s
  bool feel(Time now, double lift, double v_down, double slow, double light, double patience) {
    const bool suspicious = lift < light && std::abs(v_down) < slow;
    if (!suspicious || !watching_) since_ = now;
    watching_ = suspicious;
    felt_ = felt_ || (suspicious && seconds(now - since_) >= patience);
    return felt_;
  }

  bool felt() const { return felt_; }
  void reset() { watching_ = felt_ = false; }
  /// Goes on where another one stopped.
  void restore(bool felt) {
    watching_ = false;
    felt_ = felt;
  }

 private:
  Time since_{0};
  bool watching_ = false;
  bool felt_ = false;
};

}  // namespace ironbird::autopilot
