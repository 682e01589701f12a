#include "hil_bridge/virtual_fcu/rc.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kLeastChannel = -0.25F;
constexpr float kGreatestChannel = 1.25F;
constexpr int kFirstSwitchChannel = 4;  // the four before it are sticks
constexpr int kDirections = 4;          // SWITCH_5_DIR .. SWITCH_8_DIR
constexpr std::uint32_t kGestureTime = 1000;

/// A channel number from a parameter, kept inside the frame.
int stick_channel(std::int32_t parameter) {
  return std::clamp(static_cast<int>(parameter), 0, kRcChannels - 1);
}

}  // namespace

void Rc::configure(const ParameterStore& parameters) {
  channels_ = std::clamp(static_cast<int>(parameters.integer(parameter("RC_NUM_CHN"))), 0, kRcChannels);
  stick_channels_ = {stick_channel(parameters.integer(parameter("RC_X_CHN"))),
                     stick_channel(parameters.integer(parameter("RC_Y_CHN"))),
                     stick_channel(parameters.integer(parameter("RC_Z_CHN"))),
                     stick_channel(parameters.integer(parameter("RC_F_CHN")))};
  arm_threshold_ = parameters.real(parameter("RC_ARM_THRESHOLD"));
}

void Rc::map_switches(const ParameterStore& parameters) {
  constexpr std::array<ParameterId, kSwitches> kChannelParameters = {
      parameter("RC_ARM_CHN"), parameter("RC_ATT_OVRD_CHN"), parameter("RC_THR_OVRD_CHN"),
      parameter("RC_ATT_CTRL_CHN")};
  const int limit = parameters.integer(parameter("RC_NUM_CHN"));
  for (std::size_t k = 0; k < kSwitches; ++k) {
    const int channel = parameters.integer(kChannelParameters[k]);
    maps_[k].reset();
    if (channel < kFirstSwitchChannel || channel >= limit || channel >= kRcChannels) continue;
    const int direction = channel - kFirstSwitchChannel;
    const bool inverted =
        direction < kDirections && parameters.integer(parameter("SWITCH_5_DIR") + direction) < 0;
    maps_[k] = Map{channel, inverted};
  }
}

bool Rc::lost(const RcFrame& frame) const {
  if (frame.frame_lost || frame.failsafe) return true;
  return std::any_of(frame.channels.begin(), frame.channels.begin() + channels_,
                     [](float c) { return c < kLeastChannel || c > kGreatestChannel; });
}

bool Rc::is_on(const Map& map, float value) {
  return map.inverted ? value < 0.2F : value >= 0.8F;
}

Rc::Request Rc::decode(const RcFrame& frame, std::uint32_t now_ms, bool armed) {
  sticks_.x = 2.0F * (frame.channels[stick_channels_[0]] - 0.5F);
  sticks_.y = 2.0F * (frame.channels[stick_channels_[1]] - 0.5F);
  sticks_.z = 2.0F * (frame.channels[stick_channels_[2]] - 0.5F);
  sticks_.throttle = frame.channels[stick_channels_[3]];
  for (std::size_t k = 0; k < kSwitches; ++k) {
    on_[k] = maps_[k] && is_on(*maps_[k], frame.channels[maps_[k]->channel]);
  }
  const std::uint32_t elapsed_ms = now_ms - last_frame_ms_;
  last_frame_ms_ = now_ms;
  if (!mapped(Switch::kArm)) return look_for_gesture(elapsed_ms, armed);
  if (!on(Switch::kArm)) return Request::kDisarm;
  return armed ? Request::kNone : Request::kArm;
}

Rc::Request Rc::look_for_gesture(std::uint32_t elapsed_ms, bool armed) {
  const float corner = 1.0F - arm_threshold_;
  const bool in_corner = throttle_low() && (armed ? sticks_.z < -corner : sticks_.z > corner);
  gesture_ms_ = in_corner ? gesture_ms_ + elapsed_ms : 0;
  if (gesture_ms_ <= kGestureTime) return Request::kNone;
  if (!armed) return Request::kArm;
  gesture_ms_ = 0;
  return Request::kDisarm;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
