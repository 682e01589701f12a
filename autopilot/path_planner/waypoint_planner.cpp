#include "autopilot/path_planner/waypoint_planner.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/handover.hpp"
#include "autopilot/math/angles.hpp"
#include "autopilot/math/finite.hpp"
#include "autopilot/math/local_map.hpp"

namespace ironbird::autopilot {

namespace {

/// Checks numbers against the bounds that their description gives.
struct BoundsVisitor {
  bool& inside;

  template <class Value>
  void operator()(const char*, const Value&, const char*, const char*) const {}
  void operator()(const char*, double value, const char*, const char*, double lower, double upper) const {
    inside = inside && value >= lower && value <= upper;
  }
  void operator()(const char*, const Vector3& value, const char*, const char*, double lower,
                  double upper) const {
    inside = inside && (value.array() >= lower).all() && (value.array() <= upper).all();
  }
};

bool is_acceptable(const Waypoint& waypoint) {
  bool inside = true;
  Waypoint::describe(waypoint, BoundsVisitor{inside});
  if (waypoint.geodetic) GeodeticPosition::describe(*waypoint.geodetic, BoundsVisitor{inside});
  return inside && all_finite(waypoint);
}

bool is_geodetic(const std::vector<Waypoint>& waypoints) {
  return std::any_of(waypoints.begin(), waypoints.end(),
                     [](const Waypoint& waypoint) { return waypoint.geodetic.has_value(); });
}

bool same_place(const LocalOrigin& a, const LocalOrigin& b) {
  return a.known == b.known && a.latitude == b.latitude && a.longitude == b.longitude &&
         a.altitude == b.altitude;
}

/// The route is what is wanted, about the origin of the estimate.
bool in_force(const Handover& left) {
  const auto same = [&](const Waypoint& wanted, const Waypoint& flown) {
    return wanted.id == flown.id &&
           (!wanted.geodetic || local_from_geodetic(*wanted.geodetic, left.estimate.origin) == flown.p_N);
  };
  return left.wanted.cyclic == left.route.cyclic &&
         std::equal(left.wanted.waypoints.begin(), left.wanted.waypoints.end(), left.route.waypoints.begin(),
                    left.route.waypoints.end(), same);
}

}  // namespace

WaypointPlanner::WaypointPlanner() {
  wanted_.waypoints.reserve(kMostWaypoints);
  route_.waypoints.reserve(kMostWaypoints);
}

void WaypointPlanner::reset() {
  PathPlanner::reset();
  wanted_.waypoints.clear();
  wanted_.cyclic = waiting_ = geodetic_ = false;
  last_id_ = 0;
  origin_ = LocalOrigin{};
  flight_ = FlightMemory{};
  route_.waypoints.clear();
  route_.revision = route_.released = route_.holds = route_.holds_released = 0;
  route_.hold_time.reset();
  route_.cyclic = false;
}

void WaypointPlanner::hand_over(Handover& handover) const {
  PathPlanner::hand_over(handover);
  handover.last_waypoint_id = last_id_;
}

void WaypointPlanner::take_over(const Handover& left) {
  wanted_.waypoints.assign(left.wanted.waypoints.begin(), left.wanted.waypoints.end());
  wanted_.cyclic = left.wanted.cyclic;
  route_ = left.route;
  route_.waypoints.reserve(kMostWaypoints);
  origin_ = in_force(left) ? left.estimate.origin : LocalOrigin{};
  flight_ = left.flight.memory;
  geodetic_ = is_geodetic(wanted_.waypoints);
  waiting_ = geodetic_ && !left.estimate.origin.known;
  last_id_ = left.last_waypoint_id;
  for (const Waypoint& waypoint : wanted_.waypoints) last_id_ = std::max(last_id_, waypoint.id);
}

bool WaypointPlanner::request(const RouteRequest& request, const StateEstimate& estimate) {
  return std::visit([&](const auto& wish) { return apply(wish, estimate); }, request);
}

void WaypointPlanner::plan(const StateEstimate& estimate, const FlightStatus& flight, double) {
  flight_ = flight.memory;
  if (geodetic_ && estimate.origin.known && !same_place(origin_, estimate.origin))
    put_in_force(estimate.origin);
}

bool WaypointPlanner::apply(const AddWaypoint& wish, const StateEstimate& estimate) {
  std::vector<Waypoint>& wanted = wanted_.waypoints;
  const std::size_t at = wish.at.value_or(static_cast<std::uint32_t>(wanted.size()));
  if (at > wanted.size() || wanted.size() >= kMostWaypoints || !is_acceptable(wish.waypoint)) return false;
  const auto added = wanted.insert(wanted.begin() + static_cast<std::ptrdiff_t>(at), wish.waypoint);
  added->id = ++last_id_;
  put_in_force(estimate.origin);
  return true;
}

bool WaypointPlanner::apply(const RemoveWaypoint& wish, const StateEstimate& estimate) {
  if (wish.index >= wanted_.waypoints.size()) return false;
  wanted_.waypoints.erase(wanted_.waypoints.begin() + wish.index);
  put_in_force(estimate.origin);
  return true;
}

bool WaypointPlanner::apply(const SetRoute& wish, const StateEstimate& estimate) {
  return replace(wish.waypoints, wish.cyclic, estimate);
}

bool WaypointPlanner::apply(const ClearRoute&, const StateEstimate& estimate) {
  return replace({}, false, estimate);
}

bool WaypointPlanner::apply(const HoldHere& wish, const StateEstimate&) {
  if (wish.duration && !(std::isfinite(*wish.duration) && *wish.duration >= 0.0)) return false;
  route_.hold_time = wish.duration;
  ++route_.holds;
  ++route_.revision;
  return true;
}

bool WaypointPlanner::apply(const Release&, const StateEstimate&) {
  ++route_.released;
  route_.holds_released = route_.holds;
  return true;
}

bool WaypointPlanner::apply(const ReturnToLaunch&, const StateEstimate& estimate) {
  if (!flight_.launched) return false;
  Waypoint climb;
  climb.p_N = estimate.p_NB_N;
  climb.p_N.z() = std::min(estimate.p_NB_N.z(), flight_.launch_N.z() - params().return_height);
  climb.heading = estimate.heading;
  Waypoint land;
  land.kind = WaypointKind::kLand;
  land.p_N << flight_.launch_N.head<2>(), climb.p_N.z();
  land.heading = flight_.launch_heading;
  return replace({climb, land}, false, estimate);
}

bool WaypointPlanner::replace(const std::vector<Waypoint>& waypoints, bool cyclic,
                              const StateEstimate& estimate) {
  if (waypoints.size() > kMostWaypoints) return false;
  if (!std::all_of(waypoints.begin(), waypoints.end(), is_acceptable)) return false;
  wanted_.waypoints.assign(waypoints.begin(), waypoints.end());
  for (Waypoint& waypoint : wanted_.waypoints) waypoint.id = ++last_id_;
  wanted_.cyclic = cyclic;
  put_in_force(estimate.origin);
  return true;
}

void WaypointPlanner::put_in_force(const LocalOrigin& origin) {
  geodetic_ = is_geodetic(wanted_.waypoints);
  waiting_ = geodetic_ && !origin.known;
  if (waiting_) return;
  origin_ = origin;
  for (Waypoint& waypoint : wanted_.waypoints) {
    if (waypoint.geodetic) waypoint.p_N = local_from_geodetic(*waypoint.geodetic, origin);
  }
  route_.waypoints.assign(wanted_.waypoints.begin(), wanted_.waypoints.end());
  route_.cyclic = wanted_.cyclic;
  ++route_.revision;
}

}  // namespace ironbird::autopilot
