#pragma once

#include <utility>
#include <vector>

#include "autopilot/path_manager/path_manager.hpp"

namespace ironbird::autopilot {

inline constexpr double kRoundOff = 1e-9;

/// A waypoint with the number that a planner would have given it.
inline Waypoint waypoint(std::uint32_t id, const Vector3& p_N, double heading = 0.0,
                         WaypointKind kind = WaypointKind::kGoto) {
  Waypoint made;
  made.id = id;
  made.p_N = p_N;
  made.heading = heading;
  made.kind = kind;
  return made;
}

/// Runs a path manager at 400 Hz with a vehicle that is always where it should be, unless told to lag or to
/// stay.
class PerfectFlight {
 public:
  static constexpr double kDt = 0.0025;

  explicit PerfectFlight(PathManager& manager) : manager_(manager) {
    estimate.health = Health::kGood;
    flight.phase = FlightPhase::kOffboard;
    flight.fcu.armed = true;
  }

  const TrajectoryPoint& step() {
    estimate.stamp += std::chrono::microseconds(2500);
    const TrajectoryPoint& point = manager_.run(route, estimate, flight);
    if (follows && point.valid && flight.companion_flies()) {
      estimate.p_NB_N = point.p_N;
      estimate.v_NB_B = point.v_N;  // the attitude of this vehicle is level and north: B is N
      estimate.heading = point.heading;
    }
    last = point;
    return last;
  }

  /// Steps until `done`, at most `seconds`. @return false when the time ran out
  template <class Done>
  bool until(double seconds, Done&& done) {
    for (int i = 0; i < seconds / kDt; ++i) {
      step();
      if (done(last)) return true;
    }
    return false;
  }

  void fly(double seconds) {
    until(seconds, [](const TrajectoryPoint&) { return false; });
  }

  /// Changes the route as a planner would.
  void set(std::vector<Waypoint> waypoints, bool cyclic = false) {
    route.waypoints = std::move(waypoints);
    route.cyclic = cyclic;
    ++route.revision;
  }

  Route route;
  StateEstimate estimate;
  FlightStatus flight;
  TrajectoryPoint last;
  bool follows = true;

 private:
  PathManager& manager_;
};

}  // namespace ironbird::autopilot
