#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// The pilot's eyes: sees the vehicle leave the ground and come to rest on it again.
class GroundWatch {
 public:
  /// @return "lifted_off" when the vehicle lost the ground for the first time since it stood on it, or since
  /// it struck it; "crashed" at once when it comes down faster than a landing gear takes (2.5 m/s); "landed"
  /// when it has rested on the ground for half a second, "crashed" instead when it does not stand upright (45
  /// deg), also when it falls over on the ground, before a flight or after one, and lies for a second;
  /// otherwise nothing. Each touch-down has its own word: one that bounces and comes to rest later is not
  /// told twice.
  std::optional<std::string_view> observe(const simulator::Truth& truth);

  /// Between "lifted_off" and "landed" or "crashed".
  bool airborne() const { return airborne_; }

 private:
  std::optional<std::string_view> on_ground(const simulator::Truth& truth);
  std::optional<std::string_view> off_ground(const simulator::Truth& truth);
  bool fallen_over(const simulator::Truth& truth);

  bool airborne_ = false;
  bool crashed_ = false;  // told since "lifted_off"
  simulator::Time leaning_since_{-1};
  simulator::Time contact_since_{-1};
  simulator::Time free_since_{-1};
  double sink_ = 0.0;  // m/s, of the last moment off the ground
};

}  // namespace ironbird::scenarios
