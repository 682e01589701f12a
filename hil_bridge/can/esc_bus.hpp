#pragma once

#include <span>
#include <string>
#include <vector>

#include "hil_bridge/can/esc_node.hpp"

namespace ironbird::hil_bridge::can {

/// The motors of one vehicle on a bus.
struct EscBusParams {
  int count = 4;
  int first_node = 20;
  int status_rate = 50;
  double command_timeout = 0.1;
  bool require_arming = true;
  bool fd = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("count", self.count, "1", "motors", 1, 20);
    visit("first_node", self.first_node, "1", "number of motor 0 on the bus, the others follow", 1, 108);
    visit("status_rate", self.status_rate, "Hz", "reports of each motor a second", 10, 50);
    visit("command_timeout", self.command_timeout, "s", "a command older than this stops the motor", 0.02,
          1.0);
    visit("require_arming", self.require_arming, "1", "turns only while it hears that the vehicle is armed");
    visit("fd", self.fd, "1", "reports in CAN FD frames");
  }
};

/// The bench's side towards a flight controller with CAN motors: plays the ESCs, hands out their commands.
/// The other way round, with real ESCs, see EscController.
class EscBus {
 public:
  /// @throws std::invalid_argument when a parameter is outside its bounds.
  /// @param bus  has to outlive this
  EscBus(const EscBusParams& params, transport::FrameBus& bus, Time start);

  /// Takes what arrived, answers, sends what is due.
  /// @param readings  one for each motor
  void step(std::span<const EscReading> readings, Time now);

  /// What each motor has to do, as of the last step.
  std::span<const EscCommand> commands() const { return commands_; }
  const EscNode& node(std::size_t motor) const { return nodes_[motor]; }

 private:
  transport::FrameBus& bus_;
  std::vector<EscNode> nodes_;
  std::vector<EscCommand> commands_;
};

}  // namespace ironbird::hil_bridge::can
