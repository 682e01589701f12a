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

}  // namespace ironbird::hil_bridge
