#pragma once

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {

/// Radius of the spherical earth, m. The planner, the estimator and the simulator use the same one.
inline constexpr double kEarthRadius = 6378145.0;

/// Metres north and east of `origin`. One radius, and the cosine of the origin's latitude for all longitudes:
/// exact in both directions, 1e-6 relative per metre north away from a true sphere at 10 degrees of latitude
/// more. Not for use within 1 km of a pole. @param latitude, longitude  rad
Vector2 local_from_geodetic(double latitude, double longitude, const LocalOrigin& origin);

/// The position in N of a place on the earth, m; down is the origin's altitude less the place's.
Vector3 local_from_geodetic(const GeodeticPosition& place, const LocalOrigin& origin);

/// The place on the earth of a position in N. Inverse of local_from_geodetic to rounding; longitude in (-pi,
/// pi].
GeodeticPosition geodetic_from_local(const Vector3& p_N, const LocalOrigin& origin);

}  // namespace ironbird::autopilot
