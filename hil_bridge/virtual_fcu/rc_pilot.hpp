#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/virtual_fcu/firmware.hpp"

namespace ironbird::hil_bridge {

/// The four stick axes of a transmitter.
enum class Stick : std::uint8_t { kRoll, kPitch, kYaw, kThrottle };

constexpr std::array<std::pair<Stick, std::string_view>, 4> enumerators(Stick) {
  return {{{Stick::kRoll, "roll"},
           {Stick::kPitch, "pitch"},
           {Stick::kYaw, "yaw"},
           {Stick::kThrottle, "throttle"}}};
}

/// The simulated pilot and the transmitter in their hands: the only one who arms. Starts with sticks centred,
/// throttle down, arm switch off and the override switches on, so that the pilot has control. Flies angles.
///
/// Knows the receiver's channels from the FCU's parameters. Does not fly: sticks stay where they are put.
class RcPilot {
 public:
  /// Switches the arm switch; without one, makes the stick gesture until the FCU obeys, for at most three
  /// seconds.
  void arm(bool wanted);
  /// Switches both override switches: on, the pilot has control; off, the companion.
  void override_companion(bool wanted) { override_ = wanted; }
  /// @param value  -1..1, throttle 0..1; right, nose up, clockwise and up positive
  void set_stick(Stick stick, double value);

  /// The receiver loses the transmitter and says so in its frames.
  void lose() { link_ = Link::kLost; }
  /// The receiver itself falls silent: no frames at all, which the FCU does not notice.
  void fall_silent() { link_ = Link::kSilent; }
  /// The link is back.
  void find() { link_ = Link::kGood; }

  /// The frame that the receiver delivers now, or nothing.
  std::optional<virtual_fcu::RcFrame> frame(const virtual_fcu::Firmware& firmware, Time now);

 private:
  enum class Link : std::uint8_t { kGood, kLost, kSilent };

  bool gesture_runs(const virtual_fcu::Firmware& firmware, Time now);

  Link link_ = Link::kGood;
  bool arm_ = false;
  bool override_ = true;
  bool gesture_wanted_ = false;
  std::optional<Time> gesture_start_;
  std::array<float, 4> sticks_{};
};

}  // namespace ironbird::hil_bridge
