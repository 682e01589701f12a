#pragma once

#include "hil_bridge/can/esc_controller.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"

namespace ironbird::hil_bridge {

/// The outputs of a virtual unit with CAN motors: after every tick they leave as commands to motor
/// controllers, beside the word whether the motors may turn.
class CanOutputs {
 public:
  /// @param motors  how many outputs drive one
  /// @param bus     the unit's end, which says whether frames are CAN FD; outlives this
  CanOutputs(int motors, transport::FrameBus& bus, Time start);

  /// To be called after the unit's tick.
  void step(const VirtualFcu& unit, Time now);

  const can::EscController& controller() const { return controller_; }

 private:
  std::size_t motors_;
  can::EscController controller_;
};

}  // namespace ironbird::hil_bridge
