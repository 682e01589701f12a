#include "hil_bridge/virtual_fcu/command_mux.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr std::array<std::uint16_t, 3> kStickBits = {kRollStick, kPitchStick, kYawStick};
constexpr std::array<std::uint16_t, 3> kInactiveBits = {kRollInactive, kPitchInactive, kYawInactive};

using Kinds = std::array<ChannelKind, kMixerInputs>;

constexpr Kinds kinds(ChannelKind forces, ChannelKind roll_pitch, ChannelKind yaw) {
  Kinds result{};
  result.fill(ChannelKind::kPassThrough);
  for (int i : {kForceX, kForceY, kForceZ}) result[static_cast<std::size_t>(i)] = forces;
  result[kRoll] = result[kPitch] = roll_pitch;
  result[kYaw] = yaw;
  return result;
}

/// Per OFFBOARD_CONTROL mode.
constexpr std::array<Kinds, 3> kModes = {
    kinds(ChannelKind::kPassThrough, ChannelKind::kPassThrough, ChannelKind::kPassThrough),
    kinds(ChannelKind::kThrottle, ChannelKind::kRate, ChannelKind::kRate),
    kinds(ChannelKind::kThrottle, ChannelKind::kAngle, ChannelKind::kRate)};

void set_kinds(Command& command, const Kinds& wanted) {
  for (std::size_t i = 0; i < kMixerInputs; ++i) command.u[i].kind = wanted[i];
}

}  // namespace

CommandMux::CommandMux() {
  for (Command* command : {&pilot_, &companion_, &combined_, &failsafe_}) set_kinds(*command, kModes[2]);
}

void CommandMux::configure(const ParameterStore& parameters) {
  force_axis_ = std::clamp(static_cast<int>(parameters.integer(parameter("RC_F_AXIS"))), 0, 2);
  fixed_wing_ = parameters.on(parameter("FIXED_WING"));
  angle_mode_ = parameters.on(parameter("RC_ATT_MODE"));
  take_min_throttle_ = parameters.on(parameter("TAKE_MIN_THR"));
  deviation_ = parameters.real(parameter("RC_OVRD_DEV"));
  lag_ms_ = static_cast<std::uint32_t>(parameters.integer(parameter("RC_OVRD_LAG_T")));
  timeout_ms_ = static_cast<std::uint32_t>(parameters.integer(parameter("OFFBOARD_TIMEOUT")));
  greatest_angle_ = {parameters.real(parameter("RC_MAX_ROLL")), parameters.real(parameter("RC_MAX_PITCH"))};
  greatest_rate_ = {parameters.real(parameter("RC_MAX_ROLLRATE")),
                    parameters.real(parameter("RC_MAX_PITCHRATE")),
                    parameters.real(parameter("RC_MAX_YAWRATE"))};
}

void CommandMux::rebuild_failsafe(const ParameterStore& parameters) {
  const bool fixed_wing = parameters.on(parameter("FIXED_WING"));
  const auto axis = static_cast<std::size_t>(
      std::clamp(static_cast<int>(parameters.integer(parameter("RC_F_AXIS"))), 0, 2));
  set_kinds(failsafe_, kModes[fixed_wing ? 0 : 2]);
  for (Channel& channel : failsafe_.u) {
    channel.value = 0.0F;
    channel.active = true;
  }
  if (!fixed_wing) failsafe_.u[axis].value = parameters.real(parameter("FAILSAFE_THR"));
}

void CommandMux::take(const rosflight::OffboardControl& message, std::uint32_t now_ms) {
  if (message.mode >= kModes.size()) return;
  set_kinds(companion_, kModes[message.mode]);
  for (std::size_t i = 0; i < kMixerInputs; ++i) {
    companion_.u[i].value = message.u[i];
    companion_.u[i].active = ((message.ignore >> i) & 1U) == 0;
  }
  companion_stamp_ms_ = now_ms;
}

void CommandMux::interpret(const Rc& rc) {
  const Sticks& sticks = rc.sticks();
  for (int i : {kForceX, kForceY, kForceZ}) pilot_.u[static_cast<std::size_t>(i)].value = 0.0F;
  pilot_.u[static_cast<std::size_t>(force_axis_)].value = sticks.throttle;
  pilot_.u[kRoll].value = sticks.x;
  pilot_.u[kPitch].value = sticks.y;
  pilot_.u[kYaw].value = sticks.z;
  if (fixed_wing_) {
    set_kinds(pilot_, kModes[0]);
    return;
  }
  const bool angle = rc.mapped(Switch::kAttitudeMode) ? rc.on(Switch::kAttitudeMode) : angle_mode_;
  set_kinds(pilot_, kModes[angle ? 2 : 1]);
  pilot_.u[kRoll].value *= angle ? greatest_angle_[0] : greatest_rate_[0];
  pilot_.u[kPitch].value *= angle ? greatest_angle_[1] : greatest_rate_[1];
  pilot_.u[kYaw].value *= greatest_rate_[2];
}

void CommandMux::update(const Rc& rc, std::uint32_t now_ms) {
  interpret(rc);
  if (now_ms > companion_stamp_ms_ + timeout_ms_) {
    for (Channel& channel : companion_.u) channel.active = false;
  }
  std::uint16_t overrides = 0;
  if (rc.on(Switch::kAttitudeOverride)) overrides |= kAttitudeSwitch;
  if (rc.on(Switch::kThrottleOverride)) overrides |= kThrottleSwitch;
  overrides |= stick_overrides(rc, now_ms);
  overrides |= throttle_overrides(rc);
  overrides_ = overrides;
  combine();
}

std::uint16_t CommandMux::stick_overrides(const Rc& rc, std::uint32_t now_ms) {
  const std::array<float, 3> deflection = {rc.sticks().x, rc.sticks().y, rc.sticks().z};
  std::uint16_t bits = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (now_ms - last_deviation_ms_[k] < lag_ms_) {
      bits |= kStickBits[k];  // a deviation is not looked for while the lag of the last one runs
    } else if (std::fabs(deflection[k]) > deviation_) {
      last_deviation_ms_[k] = now_ms;
      bits |= kStickBits[k];
    }
    if (!companion_.u[kRoll + k].active) bits |= kInactiveBits[k];
  }
  return bits;
}

std::uint16_t CommandMux::throttle_overrides(const Rc& rc) const {
  const Channel& companion = companion_.u[static_cast<std::size_t>(force_axis_)];
  std::uint16_t bits = 0;
  if (!companion.active) bits |= kThrottleInactive;
  if (take_min_throttle_ && rc.sticks().throttle < companion.value) bits |= kMinimumThrottle;
  return bits;
}

void CommandMux::combine() {
  combined_ = companion_;
  for (std::size_t k = 0; k < 3; ++k) {
    if ((overrides_ & (kAttitudeSwitch | kStickBits[k] | kInactiveBits[k])) != 0) {
      combined_.u[kRoll + k] = pilot_.u[kRoll + k];
    }
  }
  if ((overrides_ & kThrottleOverrides) == 0) return;
  for (int i : {kForceX, kForceY, kForceZ}) {
    combined_.u[static_cast<std::size_t>(i)] = pilot_.u[static_cast<std::size_t>(i)];
  }
}

bool CommandMux::offboard() const {
  return std::any_of(companion_.u.begin(), companion_.u.begin() + kFirstFree,
                     [](const Channel& channel) { return channel.active; });
}

}  // namespace ironbird::hil_bridge::virtual_fcu
