#pragma once

#include <optional>

#include "autopilot/types/fcu_command.hpp"
#include "hil_bridge/rosflight/messages.hpp"

namespace ironbird::hil_bridge {

/// The wire's form of a command: OFFBOARD_CONTROL in mode 0, 1 or 2. The wire wants upward force negative in
/// pass-through and throttle positive in the other modes.
/// @return nothing for silence, and for a command with a number that is not finite as float32: it never
/// reaches the FCU
std::optional<rosflight::OffboardControl> encode(const autopilot::FcuCommand& command);

}  // namespace ironbird::hil_bridge
