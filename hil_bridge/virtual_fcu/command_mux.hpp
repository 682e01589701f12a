#pragma once

#include <array>
#include <cstdint>

#include "hil_bridge/rosflight/messages.hpp"
#include "hil_bridge/virtual_fcu/command.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"
#include "hil_bridge/virtual_fcu/rc.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

using enum rosflight::OverrideBit;
inline constexpr std::uint16_t kAttitudeOverrides =
    kAttitudeSwitch | kRollStick | kPitchStick | kYawStick | kRollInactive | kPitchInactive | kYawInactive;
inline constexpr std::uint16_t kThrottleOverrides = kThrottleSwitch | kMinimumThrottle | kThrottleInactive;

/// Decides, axis by axis, whether the pilot or the companion is flown.
///
/// Adopts the companion's commands, and notices that they are stale, only when `update` is called, which is
/// in a pass with a new usable RC frame: without RC the last combination is flown for ever.
class CommandMux {
 public:
  CommandMux();

  /// Takes over the parameters that act at once.
  void configure(const ParameterStore& parameters);
  /// Rebuilds the failsafe command: at boot and when FAILSAFE_THR or FIXED_WING changes, not with RC_F_AXIS.
  void rebuild_failsafe(const ParameterStore& parameters);

  /// Stores a command of the companion. Modes other than 0, 1 and 2 are dropped.
  /// @param now_ms  board clock
  void take(const rosflight::OffboardControl& message, std::uint32_t now_ms);

  /// Combines the pilot's and the companion's commands.
  void update(const Rc& rc, std::uint32_t now_ms);
  /// Overwrites the combination with the failsafe command; the override word stays as it is.
  void fly_failsafe() { combined_ = failsafe_; }

  const Command& pilot() const { return pilot_; }
  const Command& companion() const { return companion_; }
  const Command& combined() const { return combined_; }
  std::uint16_t overrides() const { return overrides_; }
  /// Is one of the companion's forces or torques still active?
  bool offboard() const;

 private:
  void interpret(const Rc& rc);
  std::uint16_t stick_overrides(const Rc& rc, std::uint32_t now_ms);
  std::uint16_t throttle_overrides(const Rc& rc) const;
  void combine();

  Command pilot_;
  Command companion_;
  Command combined_;
  Command failsafe_;
  std::uint32_t companion_stamp_ms_ = 0;
  std::uint16_t overrides_ = 0;
  std::array<std::uint32_t, 3> last_deviation_ms_{};

  int force_axis_ = kForceZ;
  bool fixed_wing_ = false;
  bool angle_mode_ = true;
  bool take_min_throttle_ = true;
  float deviation_ = 0.0F;
  std::uint32_t lag_ms_ = 0;
  std::uint32_t timeout_ms_ = 0;
  std::array<float, 2> greatest_angle_{};
  std::array<float, 3> greatest_rate_{};
};

}  // namespace ironbird::hil_bridge::virtual_fcu
