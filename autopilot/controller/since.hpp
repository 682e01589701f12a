#pragma once

#include <optional>

#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// How long something has been so without a break.
class Since {
 public:
  void note(bool so, Time now) {
    if (!so) {
      began_.reset();
    } else if (!began_) {
      began_ = now;
    }
  }
  void forget() { began_.reset(); }
  /// Does not count the last `gap`.
  void pass_over(Time gap) {
    if (began_) *began_ += gap;
  }
  bool so() const { return began_.has_value(); }
  /// @param duration  s
  bool lasts(double duration, Time now) const { return began_ && seconds(now - *began_) >= duration; }

 private:
  std::optional<Time> began_;
};

}  // namespace ironbird::autopilot
