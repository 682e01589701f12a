#include "hil_bridge/virtual_fcu/rc_pilot.hpp"

#include <algorithm>

namespace ironbird::hil_bridge {

using virtual_fcu::parameter;
using virtual_fcu::ParameterId;
using virtual_fcu::ParameterStore;
using virtual_fcu::RcFrame;

namespace {

constexpr Time kLongestGesture = std::chrono::seconds(3);
constexpr int kFirstSwitchChannel = 4;
constexpr int kDirections = 4;

void set_channel(RcFrame& frame, int channel, float value) {
  if (channel >= 0 && channel < virtual_fcu::kRcChannels)
    frame.channels[static_cast<std::size_t>(channel)] = value;
}

void set_switch(RcFrame& frame, const ParameterStore& parameters, ParameterId id, bool on) {
  const int channel = parameters.integer(id);
  const int direction = channel - kFirstSwitchChannel;
  if (direction < 0) return;
  const bool inverted =
      direction < kDirections && parameters.integer(parameter("SWITCH_5_DIR") + direction) < 0;
  set_channel(frame, channel, on != inverted ? 1.0F : 0.0F);
}

}  // namespace

void RcPilot::arm(bool wanted) {
  arm_ = wanted;
  gesture_wanted_ = true;
  gesture_start_.reset();
}

void RcPilot::set_stick(Stick stick, double value) {
  const double least = stick == Stick::kThrottle ? 0.0 : -1.0;
  sticks_[static_cast<std::size_t>(stick)] = static_cast<float>(std::clamp(value, least, 1.0));
}

bool RcPilot::gesture_runs(const virtual_fcu::Firmware& firmware, Time now) {
  if (!gesture_wanted_ || firmware.rc().mapped(virtual_fcu::Switch::kArm)) return false;
  if (!gesture_start_) gesture_start_ = now;
  if (firmware.arming().armed() == arm_ || now - *gesture_start_ > kLongestGesture) gesture_wanted_ = false;
  return gesture_wanted_;
}

std::optional<RcFrame> RcPilot::frame(const virtual_fcu::Firmware& firmware, Time now) {
  if (link_ == Link::kSilent) return std::nullopt;
  const ParameterStore& parameters = firmware.parameters();
  float yaw = sticks_[static_cast<std::size_t>(Stick::kYaw)];
  float throttle = sticks_[static_cast<std::size_t>(Stick::kThrottle)];
  if (gesture_runs(firmware, now)) {
    yaw = arm_ ? 1.0F : -1.0F;
    throttle = 0.0F;
  }
  RcFrame frame;
  const auto centred = [](float value) { return 0.5F * value + 0.5F; };
  set_channel(frame, parameters.integer(parameter("RC_X_CHN")),
              centred(sticks_[static_cast<std::size_t>(Stick::kRoll)]));
  set_channel(frame, parameters.integer(parameter("RC_Y_CHN")),
              centred(sticks_[static_cast<std::size_t>(Stick::kPitch)]));
  set_channel(frame, parameters.integer(parameter("RC_Z_CHN")), centred(yaw));
  set_channel(frame, parameters.integer(parameter("RC_F_CHN")), throttle);
  set_switch(frame, parameters, parameter("RC_ARM_CHN"), arm_);
  set_switch(frame, parameters, parameter("RC_ATT_OVRD_CHN"), override_);
  set_switch(frame, parameters, parameter("RC_THR_OVRD_CHN"), override_);
  set_switch(frame, parameters, parameter("RC_ATT_CTRL_CHN"), true);
  frame.failsafe = link_ == Link::kLost;
  return frame;
}

}  // namespace ironbird::hil_bridge
