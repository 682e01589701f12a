#pragma once

#include <cstdint>
#include <optional>

#include "autopilot/controller/flight_phase.hpp"
#include "autopilot/request.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

/// What a module leaves to the one that takes its place: all that the last tick computed, and what was
/// granted to it since or has to wait for its period. No `describe` of its own: it lives for one exchange. A
/// planner leaves in `route` the newest, a manager the one that it has noticed so far.
struct Handover : Signals {
  Handover() = default;
  /// Nothing was granted since.
  Handover(const Signals& last) : Signals(last), wanted{route.waypoints, route.cyclic} {}

  SetRoute wanted;                     ///< by the operator; in `route` when it waits for no origin
  std::uint32_t last_waypoint_id = 0;  ///< the greatest number ever given to a waypoint
  std::optional<FlightWish> wish;      ///< granted for the next work of the controller
  std::optional<Time> armed_at;        ///< when the controller saw the vehicle arming
  bool new_setpoint = false;           ///< the operator's came or went since the last tick
};

}  // namespace ironbird::autopilot
