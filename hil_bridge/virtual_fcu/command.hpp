#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// How the value of a channel is meant.
enum class ChannelKind : std::uint8_t { kRate, kAngle, kThrottle, kPassThrough };

constexpr std::array<std::pair<ChannelKind, std::string_view>, 4> enumerators(ChannelKind) {
  return {{{ChannelKind::kRate, "rate"},
           {ChannelKind::kAngle, "angle"},
           {ChannelKind::kThrottle, "throttle"},
           {ChannelKind::kPassThrough, "pass_through"}}};
}

// Places in a command: three forces, three torques, four free mixer inputs.
inline constexpr int kForceX = 0;
inline constexpr int kForceY = 1;
inline constexpr int kForceZ = 2;
inline constexpr int kRoll = 3;
inline constexpr int kPitch = 4;
inline constexpr int kYaw = 5;
inline constexpr int kFirstFree = 6;

/// One channel of a command.
struct Channel {
  float value = 0.0F;
  ChannelKind kind = ChannelKind::kThrottle;
  bool active = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("value", self.value, "SI", "force, torque, rad/s, rad or throttle, as `kind` says");
    visit("kind", self.kind, "1", "how the value is meant");
    visit("active", self.active, "1", "somebody commands it");
  }
};

/// Ten channels: the pilot's, the companion's, or the combination that is flown.
struct Command {
  std::array<Channel, kMixerInputs> u{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("u", self.u, "", "forces x y z, torques x y z, four free mixer inputs");
  }
};

}  // namespace ironbird::hil_bridge::virtual_fcu
