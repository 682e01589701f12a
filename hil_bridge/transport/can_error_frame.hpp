#pragma once

#include <optional>

#include "hil_bridge/can/bounded_list.hpp"
#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::transport {

/// More than one error frame can say.
using ErrorEvents = can::BoundedList<BusEvent, 9>;

/// Takes the kernel's error frame apart, causes before consequences.
ErrorEvents events_of(const CanFrame& error, Time stamp);

/// The state that an event leads to, or nothing when it says nothing of it.
std::optional<BusState> state_after(BusEventKind kind);

}  // namespace ironbird::hil_bridge::transport
