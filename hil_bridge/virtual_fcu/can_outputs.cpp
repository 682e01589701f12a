#include "hil_bridge/virtual_fcu/can_outputs.hpp"

#include <algorithm>
#include <span>

namespace ironbird::hil_bridge {

namespace {

can::EscControllerParams params_for(int motors, bool fd) {
  can::EscControllerParams params;
  params.count = motors;
  params.fd = fd;
  return params;
}

}  // namespace

CanOutputs::CanOutputs(int motors, transport::FrameBus& bus, Time start)
    : motors_(static_cast<std::size_t>(motors)), controller_(params_for(motors, bus.fd()), bus, start) {}

void CanOutputs::step(const VirtualFcu& unit, Time now) {
  simulator::RotorCommands outputs = unit.commands();
  for (double& throttle : outputs.throttle) throttle = std::min(throttle, 1.0);
  controller_.set_armed(unit.firmware().arming().armed());
  controller_.command(std::span(outputs.throttle).first(std::min(motors_, outputs.throttle.size())), now);
  controller_.step(now);
}

}  // namespace ironbird::hil_bridge
