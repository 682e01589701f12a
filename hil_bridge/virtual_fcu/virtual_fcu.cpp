#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"

namespace ironbird::hil_bridge {

VirtualFcu::VirtualFcu(const VirtualFcuConfig& config, simulator::World& world)
    : world_(world), tick_(config.tick), on_desk_(config.on_desk), host_(config) {}

void VirtualFcu::advance(Time now) {
  while (host_.now() + tick_ <= now) {
    const Time next = host_.now() + tick_;
    world_.set_armed(host_.firmware().arming().armed());
    world_.step(on_desk_ ? simulator::RotorCommands{} : host_.commands(), next);
    host_.tick(world_.readings(), next);
  }
}

}  // namespace ironbird::hil_bridge
