#pragma once

#include <algorithm>
#include <cmath>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// How much the airframe shakes: the root mean square, over a second, of the specific force less its low
/// pass. docs/equations.md, section 3.
class VibrationWatch {
 public:
  /// @param f_B  specific force, m/s^2
  /// @param dt   since the sample before, s, > 0
  void add(const Vector3& f_B, double dt) {
    constexpr double kSlowAfter = 0.1;   // s, what changes slower is the vehicle's motion
    constexpr double kRemembered = 1.0;  // s
    if (!started_) f_slow_B_ = f_B;
    started_ = true;
    f_slow_B_ += std::min(dt / kSlowAfter, 1.0) * (f_B - f_slow_B_);
    mean_square_ += std::min(dt / kRemembered, 1.0) * ((f_B - f_slow_B_).squaredNorm() - mean_square_);
  }

  /// m/s^2
  double rms() const { return std::sqrt(mean_square_); }

 private:
  bool started_ = false;
  Vector3 f_slow_B_ = Vector3::Zero();
  double mean_square_ = 0.0;
};

}  // namespace ironbird::autopilot
