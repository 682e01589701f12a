#pragma once

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// Where the real-time executive gets the time, and where it waits. Tests let it pass by hand.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Time since the start of the run; never less than before.
  virtual Time now() = 0;

  /// Returns when `descriptor` can be read, or at `until`, whichever comes first.
  /// @param descriptor  for poll(2); -1: only the time counts
  virtual void wait(int descriptor, Time until) = 0;
};

}  // namespace ironbird::hil_bridge
