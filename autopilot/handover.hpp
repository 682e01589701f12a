#pragma once

#include <cstdint>

#include "autopilot/controller/flight_phase.hpp"
#include "autopilot/request.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

/// What a module leaves to the one that takes its place: all that the last tick computed, and what was
/// granted to it since or has to wait for its period. No `describe`: it lives for one exchange.
struct Handover : Signals {
  Handover() = default;
  /// Nothing was granted since.
  Handover(const Signals& last) : Signals(last), wanted{route.waypoints, route.cyclic} {}

  SetRoute wanted;                     ///< the operator's; `route` may wait for an origin
  std::uint32_t last_waypoint_id = 0;  ///< the greatest number ever given to a waypoint
  FlightWishes wishes{};               ///< for the next work of the controller
};

}  // namespace ironbird::autopilot
