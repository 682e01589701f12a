#pragma once

#include <optional>
#include <string_view>

#include "autopilot/signals.hpp"

namespace ironbird::scenarios {

/// Lift-off and landing as the autopilot feels them: on a real vehicle nobody else tells. It cannot tell a
/// crash: who falls feels no ground.
class FeltGround {
 public:
  /// @return "lifted_off" when the vehicle has left the ground by half a metre, "landed" when the autopilot
  /// has felt the ground for half a second since then or until it was disarmed, or lay still while
  /// the pilot had the vehicle
  std::optional<std::string_view> observe(const autopilot::Signals& signals);

 private:
  bool airborne_ = false;
  std::optional<autopilot::Time> felt_since_;
};

}  // namespace ironbird::scenarios
