#pragma once

#include <optional>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// Decides, message by message, what leaves the bench towards a unit. Whoever writes to a line asks it first.
class Gate {
 public:
  virtual ~Gate() = default;

  /// @return the message that leaves instead of this one, which may be the same, or none
  virtual std::optional<rosflight::Message> pass(const rosflight::Message& message, Time now) = 0;
};

/// Lets everything pass. For units that exist in this process only: their propellers are numbers.
class SimulatedUnitGate final : public Gate {
 public:
  std::optional<rosflight::Message> pass(const rosflight::Message& message, Time) override { return message; }
};

}  // namespace ironbird::hil_bridge
