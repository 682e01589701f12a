#pragma once

#include <vector>

#include "hil_bridge/virtual_fcu/firmware_host.hpp"
#include "simulator/world.hpp"

namespace ironbird::hil_bridge {

/// A flight-control unit whose rotors and sensors are simulated: letting time pass steps the world with the
/// motor outputs held, then runs the firmware on what the sensors delivered.
class VirtualFcu final : public Fcu {
 public:
  /// @param world  stepped by nobody else; outlives this
  /// @throws std::invalid_argument naming key, value and bound
  VirtualFcu(const VirtualFcuConfig& config, simulator::World& world);

  /// Steps world and firmware tick by tick as far as `now` allows.
  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override { host_.receive(out); }
  void send(const rosflight::Message& message) override { host_.send(message); }

  /// Whom scenario events talk to.
  RcPilot& pilot() { return host_.pilot(); }
  const virtual_fcu::Firmware& firmware() const { return host_.firmware(); }
  /// What the rotors are told until the next tick.
  simulator::RotorCommands commands() const { return host_.commands(); }

 private:
  simulator::World& world_;
  Time tick_;
  bool on_desk_;
  FirmwareHost host_;
};

}  // namespace ironbird::hil_bridge
