#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "hil_bridge/rosflight/messages.hpp"

namespace ironbird::hil_bridge {

/// Time since the start of the run.
using Time = std::chrono::nanoseconds;

/// A message with the time at which it arrived at the companion computer.
struct Arrival {
  Time when{};
  rosflight::Message message;
  std::optional<std::uint8_t>
      odd_system{};  ///< the system number it carries on a line, where that is not the unit's
};

/// A flight-control unit, real or virtual, seen from the companion computer.
class Fcu {
 public:
  virtual ~Fcu() = default;

  /// Lets time pass until `now`: a virtual unit simulates, a real one does nothing.
  virtual void advance(Time now) = 0;

  /// Appends everything that arrived since the last call, oldest first.
  virtual void receive(std::vector<Arrival>& out) = 0;

  /// Sends one message.
  virtual void send(const rosflight::Message& message) = 0;
};

}  // namespace ironbird::hil_bridge
