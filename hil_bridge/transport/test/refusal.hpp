#pragma once

#include <stdexcept>
#include <string>

#include "hil_bridge/transport/socket_can.hpp"

namespace ironbird::hil_bridge::transport {

/// What an interface says that cannot be opened so.
inline std::string refusal(const SocketCanParams& params) {
  try {
    SocketCan bus(params);
    return "taken";
  } catch (const std::invalid_argument& problem) {
    return problem.what();
  }
}

}  // namespace ironbird::hil_bridge::transport
