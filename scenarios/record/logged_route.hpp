#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {

/// A route as a log has it. Every change of the mission makes another.
struct LoggedRoute {
  double since = 0.0;
  double until = 0.0;
  bool cyclic = false;
  std::vector<Eigen::Vector3d> waypoints_N;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("since", self.since, "s", "when it came into force, since the start of the run");
    visit("until", self.until, "s", "when the next one did, or the log ended");
    visit("cyclic", self.cyclic, "1", "after the last waypoint comes the first");
    visit("waypoints_N", self.waypoints_N, "m", "from the local origin");
  }

  /// Is `other` this route with other waypoints behind the first, not a route of its own such as the way
  /// home?
  bool begins_like(const LoggedRoute& other) const {
    return !waypoints_N.empty() && !other.waypoints_N.empty() &&
           waypoints_N.front() == other.waypoints_N.front();
  }
};

/// All routes of a log in order of time; none when it has no /autopilot/route.
std::vector<LoggedRoute> logged_routes(const Log& log);

/// The route that was in force for the longest time of those that have waypoints: what the flight was about,
/// whatever came before and after it, such as the way home. What every picture and figure calls the route of
/// a run.
std::optional<std::size_t> main_route(const std::vector<LoggedRoute>& routes);

}  // namespace ironbird::scenarios
