#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// What to do at a waypoint.
enum class WaypointKind : std::uint8_t {
  kGoto,  ///< fly there and on
  kHold,  ///< fly there and stay for `hold_time`, or until released
  kLand   ///< fly there and descend; on the ground no thrust until the pilot disarms
};

constexpr std::array<std::pair<WaypointKind, std::string_view>, 3> enumerators(WaypointKind) {
  return {{{WaypointKind::kGoto, "goto"}, {WaypointKind::kHold, "hold"}, {WaypointKind::kLand, "land"}}};
}

/// A place on the earth, double precision throughout.
struct GeodeticPosition {
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("latitude", self.latitude, "rad", "geodetic latitude, north positive", -1.5707963267948966,
          1.5707963267948966);
    visit("longitude", self.longitude, "rad", "longitude, east positive", -3.1415926535897931,
          3.1415926535897931);
    visit("altitude", self.altitude, "m", "height above mean sea level", -500.0, 9000.0);
  }
};

/// The most waypoints that a route holds, so that no tick ever needs more memory than was set aside.
inline constexpr std::size_t kMostWaypoints = 256;

/// How far from the origin a waypoint may be along each axis, m. Farther the one latitude of the local map is
/// no longer that of the place.
inline constexpr double kFarthestWaypoint = 1e5;

/// A place to fly to and what to do there. Given either in N or on the earth; the planner fills `p_N` from
/// `geodetic`.
struct Waypoint {
  WaypointKind kind = WaypointKind::kGoto;
  Vector3 p_N = Vector3::Zero();
  std::optional<GeodeticPosition> geodetic;
  double heading = 0.0;
  double speed = 0.0;
  double hold_time = 0.0;
  bool hold_indefinitely = false;
  std::uint32_t id = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "goto, hold or land");
    visit("p_N", self.p_N, "m", "position from the local origin", -kFarthestWaypoint, kFarthestWaypoint);
    visit("geodetic", self.geodetic, "", "position on the earth; wins over p_N");
    visit("heading", self.heading, "rad", "heading at the waypoint", -6.283185307179586, 6.283185307179586);
    visit("speed", self.speed, "m/s", "greatest speed on the leg to it; 0: the path manager's limit", 0.0,
          50.0);
    visit("hold_time", self.hold_time, "s", "how long a hold lasts", 0.0, 86400.0);
    visit("hold_indefinitely", self.hold_indefinitely, "1", "a hold lasts until released");
    visit("id", self.id, "1", "the planner's number of it, never used twice; set by the planner");
  }
};

/// The waypoints in force, in N. A new revision means that something other than `released` changed.
struct Route {
  std::uint32_t revision = 0;
  std::uint32_t released = 0;
  std::uint32_t holds = 0;
  std::uint32_t holds_released = 0;
  std::optional<double> hold_time;
  bool cyclic = false;
  std::vector<Waypoint> waypoints;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("revision", self.revision, "1", "raised by every change");
    visit("released", self.released, "1", "how often a hold was released by request");
    visit("holds", self.holds, "1", "how often a hold on the spot was requested");
    visit("holds_released", self.holds_released, "1",
          "how many of these had been when the last release came");
    visit("hold_time", self.hold_time, "s", "how long the last of these lasts; none: until released");
    visit("cyclic", self.cyclic, "1", "after the last waypoint comes the first");
    visit("waypoints", self.waypoints, "", "in order of flight");
  }
};

}  // namespace ironbird::autopilot
