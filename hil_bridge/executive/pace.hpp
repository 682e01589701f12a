#pragma once

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// Lets the time of a run pass no faster than the clock of the wall, or a fraction of it: for a unit that
/// does not wait.
///
/// A loop that falls far behind does not catch up, since whoever is at the other end of the line goes on: its
/// clock is set anew, and what was lost is counted.
class Pace {
 public:
  /// Further behind there is no catching up, of the clock of the wall.
  static constexpr Time kGivenUp = std::chrono::milliseconds(200);

  /// @param time_scale  seconds of the run in a second of the clock, 0.001 to 1
  /// @throws std::invalid_argument naming value and bound
  explicit Pace(double time_scale);

  /// Waits until it is time. @return what was lost on the way, because the loop came too late, of the run's
  /// time
  Time wait(Time now);

  /// Of the clock of the wall.
  Time lost() const { return lost_; }

 private:
  double time_scale_;
  Time zero_ = Time::min();  // of the run, on the clock of the wall
  Time lost_{};
};

}  // namespace ironbird::hil_bridge
