#include "autopilot/path_manager/minimum_snap_manager.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kSamePlace = 1e-3;  // m

bool is_near(const Vector3& a_N, const Vector3& b_N) {
  return (a_N - b_N).norm() < kSamePlace;
}

}  // namespace

void MinimumSnapManager::on_parameters() {
  Rules rules;
  rules.limits = params();
  rules.waypoint_tolerance = params().waypoint_tolerance;
  set_rules(rules);
}

std::uint32_t MinimumSnapManager::depart(const Departure& departure, const Route& route,
                                         std::uint32_t first) {
  trajectory_.begin(departure.p_N, departure.heading);
  const auto count = static_cast<std::uint32_t>(route.waypoints.size());
  std::uint32_t last = first;
  for (bool stops = false; !stops; ++last) {
    const Waypoint& to = route.waypoints[last];
    trajectory_.add(to.p_N, to.heading, to.speed > 0.0 ? to.speed : params().max_velocity);
    const bool begins_here = last == first && is_near(departure.p_N, to.p_N);
    stops = begins_here || to.kind != WaypointKind::kGoto || last + 1 == count ||
            trajectory_.legs() == MinimumSnapTrajectory::kMostLegs ||
            is_near(to.p_N, route.waypoints[last + 1].p_N);
  }
  const std::size_t legs = trajectory_.solve(params(), params().max_excursion);
  return first + static_cast<std::uint32_t>(legs) - 1;
}

}  // namespace ironbird::autopilot
