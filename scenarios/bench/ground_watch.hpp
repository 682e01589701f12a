#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// The pilot's eyes: sees the vehicle leave the ground and come to rest on it again.
class GroundWatch {
 public:
  /// @return "lifted_off" when the vehicle lost the ground for the first time since it stood on it, "landed"
  /// when it has rested on the ground for half a second since then, "crashed" instead when it came down
  /// faster than a landing gear takes (2.5 m/s) or does not stand upright (45 deg), "crashed" also when it
  /// falls over on the ground, before a flight or after one, and lies for a second; otherwise nothing
  std::optional<std::string_view> observe(const simulator::Truth& truth);

  /// Between "lifted_off" and "landed" or "crashed".
  bool airborne() const { return airborne_; }

 private:
  bool fallen_over(const simulator::Truth& truth);

  bool airborne_ = false;
  bool crashed_ = false;  // told, since "lifted_off"
  simulator::Time leaning_since_{-1};
  simulator::Time contact_since_{-1};
  simulator::Time free_since_{-1};
  double sink_ = 0.0;     // m/s, of the last moment off the ground
  double hardest_ = 0.0;  // m/s, of the touch-downs since "lifted_off"
};

}  // namespace ironbird::scenarios
