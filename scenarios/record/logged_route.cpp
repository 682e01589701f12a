#include "scenarios/record/logged_route.hpp"

#include "scenarios/record/topics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace ironbird::scenarios {

namespace {

/// The waypoints of one message. A log has a column for each that any of its routes has.
std::vector<Eigen::Vector3d> waypoints_at(const LogTopic& route, std::size_t message) {
  std::vector<Eigen::Vector3d> waypoints_N;
  for (;;) {
    const std::string name = "waypoints[" + std::to_string(waypoints_N.size()) + "].p_N.";
    Eigen::Vector3d p_N;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string field = name + "xyz"[axis];
      if (!route.has(field) || !std::isfinite(route.column(field)[message])) return waypoints_N;
      p_N[axis] = route.column(field)[message];
    }
    waypoints_N.push_back(p_N);
  }
}

double end_of(const Log& log, double otherwise) {
  const LogTopic* flown = log.topic(kTrajectoryTopic);
  return flown == nullptr || flown->time().empty() ? otherwise : std::max(otherwise, flown->time().back());
}

}  // namespace

std::vector<LoggedRoute> logged_routes(const Log& log) {
  std::vector<LoggedRoute> routes;
  const LogTopic* topic = log.topic(kRouteTopic);
  if (topic == nullptr) return routes;
  const std::vector<double>& time = topic->time();
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double until = k + 1 < time.size() ? time[k + 1] : end_of(log, time[k]);
    const bool cyclic = topic->has("cyclic") && topic->column("cyclic")[k] == 1.0;
    routes.push_back({time[k], until, cyclic, waypoints_at(*topic, k)});
  }
  return routes;
}

std::optional<std::size_t> main_route(const std::vector<LoggedRoute>& routes) {
  std::optional<std::size_t> found;
  double longest = -1.0;
  for (std::size_t k = 0; k < routes.size(); ++k) {
    const double in_force = routes[k].until - routes[k].since;
    if (routes[k].waypoints_N.empty() || in_force <= longest) continue;
    longest = in_force;
    found = k;
  }
  return found;
}

}  // namespace ironbird::scenarios
