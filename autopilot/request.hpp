#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "autopilot/module/parameter_table.hpp"
#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/mission.hpp"

namespace ironbird::autopilot {

// What an operator may ask between two ticks.

/// Adds a waypoint before index `at`, or at the end.
struct AddWaypoint {
  Waypoint waypoint;
  std::optional<std::uint32_t> at;
};
/// Removes the waypoint with this index.
struct RemoveWaypoint {
  std::uint32_t index = 0;
};
/// Replaces the whole route.
struct SetRoute {
  std::vector<Waypoint> waypoints;
  bool cyclic = false;
};
/// Empties the route: the vehicle holds where it is.
struct ClearRoute {};
/// Holds here for `duration` seconds, or until released, then flies on.
struct HoldHere {
  std::optional<double> duration;
};
/// Ends a hold.
struct Release {};
/// Flies back to where the vehicle took off and lands there.
struct ReturnToLaunch {};

using RouteRequest =
    std::variant<AddWaypoint, RemoveWaypoint, SetRoute, ClearRoute, HoldHere, Release, ReturnToLaunch>;

/// Takes off now. Refused, and forgotten, unless the vehicle stands armed, nobody else has it, and there is
/// an estimate to fly on.
struct TakeOff {};
/// Descends here; on the ground no thrust is asked for until the pilot disarms, which the companion cannot.
struct Land {};
/// Ends a descent, or the silence after the estimate was lost: holds, then flies on.
struct Resume {};
/// Asks for the waypoints that are wanted; the answer has a line for each.
struct ListRoute {};
/// Sets one parameter.
struct SetParameter {
  std::string path;
  ParameterValue value;
};
/// Replaces the module in `slot` (estimator, path_planner, path_manager, trajectory_follower, controller) by
/// one of `kind`. The newcomer gets `settings` and whatever the operator has set since, and from a
/// predecessor of its own kind everything.
struct SwapModule {
  std::string slot;
  std::string kind;
  std::vector<ParameterSetting> settings = {};
};
/// Flies this setpoint instead of the follower's, at any of the twelve entry points; empty: the follower
/// flies again.
struct OverrideSetpoint {
  std::optional<ControlSetpoint> setpoint;
};

using Request =
    std::variant<RouteRequest, ListRoute, TakeOff, Land, Resume, SetParameter, SwapModule, OverrideSetpoint>;

/// What became of a request; logged by the bench.
struct RequestOutcome {
  bool accepted = false;
  std::string reason;
  std::vector<std::string> answer = {};
};

}  // namespace ironbird::autopilot
