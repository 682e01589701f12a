#pragma once

#include "hil_bridge/can/esc_messages.hpp"
#include "hil_bridge/can/node_messages.hpp"
#include "hil_bridge/can/parameter_messages.hpp"

// The DroneCAN messages of motors and of the nodes that drive them, as plain structs. Names, types and order
// are those of the public definitions; each struct's `describe` is the one place that says how it lies on the
// wire: see serialisation.hpp.
