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

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("waypoint", self.waypoint, "", "the waypoint");
    visit("at", self.at, "1", "index it gets; absent: the end");
  }
};
/// Removes the waypoint with this index.
struct RemoveWaypoint {
  std::uint32_t index = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("index", self.index, "1", "which, from 0");
  }
};
/// Replaces the whole route.
struct SetRoute {
  std::vector<Waypoint> waypoints;
  bool cyclic = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("waypoints", self.waypoints, "", "in the order of flight");
    visit("cyclic", self.cyclic, "1", "after the last comes the first");
  }
};
/// Empties the route: the vehicle holds where it is.
struct ClearRoute {};
/// Holds here for `duration` seconds, or until released, then flies on.
struct HoldHere {
  std::optional<double> duration;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("duration", self.duration, "s", "how long; absent: until released");
  }
};
/// Ends a hold.
struct Release {};
/// Flies back to where the vehicle took off and lands there. Refused on the ground.
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
/// Asks for the waypoints that are wanted.
struct ListRoute {};
/// Sets one parameter. No `describe`: the value may be of three types.
struct SetParameter {
  std::string path;
  ParameterValue value;
};
/// Replaces the module in `slot` (estimator, path_planner, path_manager, trajectory_follower, controller) by
/// one of `kind`. The newcomer gets `settings` and whatever the operator has set since, and from a
/// predecessor of its own kind everything. No `describe`: the settings may be of three types.
struct SwapModule {
  std::string slot;
  std::string kind;
  std::vector<ParameterSetting> settings = {};
};
/// Flies this setpoint instead of the follower's, at any of the twelve entry points; empty: the follower
/// flies again. No `describe`: each entry point has its own members, described in `control_setpoint.hpp`.
struct OverrideSetpoint {
  std::optional<ControlSetpoint> setpoint;
};

using Request =
    std::variant<RouteRequest, ListRoute, TakeOff, Land, Resume, SetParameter, SwapModule, OverrideSetpoint>;

/// What became of a request; logged by the bench.
struct RequestOutcome {
  bool accepted = false;
  std::string reason;
  std::vector<Waypoint> waypoints = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("accepted", self.accepted, "1", "it is done, or will be at the next step");
    visit("reason", self.reason, "", "why it was refused; empty when it was not");
    visit("waypoints", self.waypoints, "", "those wanted, for whoever asked for the list");
  }
};

}  // namespace ironbird::autopilot
