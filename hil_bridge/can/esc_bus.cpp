#include "hil_bridge/can/esc_bus.hpp"

#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::can {

EscBus::EscBus(const EscBusParams& params, transport::FrameBus& bus, Time start) : bus_(bus) {
  simulator::check_bounds(params, "esc_bus");
  nodes_.reserve(static_cast<std::size_t>(params.count));
  for (int motor = 0; motor < params.count; ++motor) {
    EscNodeParams node;
    node.node = params.first_node + motor;
    node.esc_index = motor;
    node.status_rate = params.status_rate;
    node.command_timeout = params.command_timeout;
    node.require_arming = params.require_arming;
    node.fd = params.fd;
    nodes_.emplace_back(node, start);
  }
  commands_.resize(nodes_.size());
}

void EscBus::step(std::span<const EscReading> readings, Time now) {
  while (const std::optional<ReceivedFrame> frame = bus_.receive()) {
    for (EscNode& node : nodes_) node.take(*frame, now);
  }
  for (std::size_t motor = 0; motor < nodes_.size(); ++motor) {
    nodes_[motor].step(motor < readings.size() ? readings[motor] : EscReading{}, now, bus_);
    commands_[motor] = nodes_[motor].command(now);
  }
}

}  // namespace ironbird::hil_bridge::can
