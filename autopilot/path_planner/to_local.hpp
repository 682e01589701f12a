#pragma once

#include <cmath>

#include "autopilot/math/angles.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// The position in N of a place on the earth, m: the spherical map of the ROScopter paper, section on the
/// estimator, with the radius of Small Unmanned Aircraft, 6378145 m. Double precision throughout.
inline Vector3 to_local(const GeodeticPosition& place, const LocalOrigin& origin) {
  constexpr double kEarthRadius = 6378145.0;  // m
  return {kEarthRadius * (place.latitude - origin.latitude),
          kEarthRadius * std::cos(origin.latitude) * shortest_difference(place.longitude, origin.longitude),
          origin.altitude - place.altitude};
}

}  // namespace ironbird::autopilot
