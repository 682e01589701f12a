#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::transport {

/// What the kernel says of a network interface, as far as CAN goes.
struct CanLink {
  int index = 0;
  bool can = false;
  bool up = false;
  bool fd = false;
  std::string kind;
  std::uint32_t bit_rate = 0;
  BusState state = BusState::kActive;
  std::uint16_t send_errors = 0;
  std::uint16_t receive_errors = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("index", self.index, "1", "the kernel's number of the interface");
    visit("can", self.can, "1", "it is a CAN interface");
    visit("up", self.up, "1", "switched on");
    visit("fd", self.fd, "1", "carries CAN FD frames");
    visit("kind", self.kind, "", "can for a controller, vcan for one without hardware");
    visit("bit_rate", self.bit_rate, "bit/s", "0 when it has none");
    visit("state", self.state, "1", "what its error counters come to; active when it does not tell");
    visit("send_errors", self.send_errors, "1", "error counter");
    visit("receive_errors", self.receive_errors, "1", "error counter");
  }
};

/// Asks the kernel. Nothing when there is no interface of that name.
std::optional<CanLink> read_can_link(const std::string& name);

/// The names of all CAN interfaces.
std::vector<std::string> can_interfaces();

}  // namespace ironbird::hil_bridge::transport
