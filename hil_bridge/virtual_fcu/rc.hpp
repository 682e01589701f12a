#pragma once

#include <cstdint>
#include <optional>

#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// The pilot's sticks: x, y, z in -1..1 (roll, pitch, yaw), throttle in 0..1. No dead band.
struct Sticks {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
  float throttle = 0.0F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("x", self.x, "1", "roll, right positive");
    visit("y", self.y, "1", "pitch, nose up positive");
    visit("z", self.z, "1", "yaw, clockwise positive");
    visit("throttle", self.throttle, "1", "0..1");
  }
};

/// The four switches that can be mapped to a channel.
enum class Switch : std::uint8_t { kArm, kAttitudeOverride, kThrottleOverride, kAttitudeMode };
inline constexpr int kSwitches = 4;

/// Decoder of the pilot's frames: validity, sticks, switches and arming gestures.
/// Judges received frames only: silence is not detected, here as in the firmware.
class Rc {
 public:
  /// What the pilot asks for with this frame.
  enum class Request : std::uint8_t { kNone, kArm, kDisarm };

  /// Takes over the parameters that act at once.
  void configure(const ParameterStore& parameters);
  /// Finds out which switch is on which channel: at boot and when a switch parameter changes.
  void map_switches(const ParameterStore& parameters);

  /// Is the frame unusable: flagged by the receiver, or one of the first RC_NUM_CHN channels outside
  /// -0.25..1.25?
  bool lost(const RcFrame& frame) const;

  /// Decodes a usable frame.
  /// @param now_ms  board clock
  Request decode(const RcFrame& frame, std::uint32_t now_ms, bool armed);

  const Sticks& sticks() const { return sticks_; }
  bool mapped(Switch which) const { return maps_[index(which)].has_value(); }
  /// Channel of a switch, or -1.
  int channel(Switch which) const { return maps_[index(which)] ? maps_[index(which)]->channel : -1; }
  bool on(Switch which) const { return on_[index(which)]; }
  bool throttle_low() const { return sticks_.throttle < arm_threshold_; }

 private:
  struct Map {
    int channel = 0;
    bool inverted = false;
  };

  static std::size_t index(Switch which) { return static_cast<std::size_t>(which); }
  static bool is_on(const Map& map, float value);
  Request look_for_gesture(std::uint32_t elapsed_ms, bool armed);

  std::array<std::optional<Map>, kSwitches> maps_{};
  std::array<bool, kSwitches> on_{};
  Sticks sticks_;
  int channels_ = 0;
  std::array<int, 4> stick_channels_{};
  float arm_threshold_ = 0.0F;
  std::uint32_t last_frame_ms_ = 0;
  std::uint32_t gesture_ms_ = 0;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
