#pragma once

#include <optional>

#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// How fast a descent may sink now. A vehicle that moves comes to rest over its place first, at its height;
/// then it sinks. What is asked for begins with what the vehicle does and never goes up. It does not know the
/// ground.
class Descent {
 public:
  /// The vertical velocity to ask for, m/s, >= 0.
  /// @param wanted        m/s, >= 0
  /// @param dt            since the previous step, s
  /// @param deceleration  what the vehicle brakes with horizontally, and sinks faster with, m/s^2, > 0
  /// @param catching      what it sinks slower with, m/s^2, > 0
  double sink(const StateEstimate& estimate, double wanted, double dt, double deceleration, double catching);

  /// The next step begins anew.
  void reset() { v_down_.reset(); }

 private:
  void begin(const StateEstimate& estimate, double deceleration);

  std::optional<double> v_down_;  // m/s, asked for last; none: it has not begun
  bool brakes_ = false;
  Time brake_ends_{0};
};

}  // namespace ironbird::autopilot
