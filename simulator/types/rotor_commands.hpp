#pragma once

#include <array>

namespace ironbird::simulator {

/// The most rotors that a vehicle can have.
inline constexpr int kMaxRotors = 8;

/// What the speed controllers are told, one number per rotor in the vehicle's order.
struct RotorCommands {
  std::array<double, kMaxRotors> throttle{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("throttle", self.throttle, "1", "share of the battery's voltage, 0..1");
  }
};

}  // namespace ironbird::simulator
