#include "autopilot/math/local_map.hpp"

#include <cmath>

#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

Vector2 local_from_geodetic(double latitude, double longitude, const LocalOrigin& origin) {
  const double north = kEarthRadius * (latitude - origin.latitude);
  const double east =
      kEarthRadius * std::cos(origin.latitude) * shortest_difference(longitude, origin.longitude);
  return {north, east};
}

Vector3 local_from_geodetic(const GeodeticPosition& place, const LocalOrigin& origin) {
  const Vector2 p = local_from_geodetic(place.latitude, place.longitude, origin);
  return {p.x(), p.y(), origin.altitude - place.altitude};
}

GeodeticPosition geodetic_from_local(const Vector3& p_N, const LocalOrigin& origin) {
  GeodeticPosition place;
  place.latitude = origin.latitude + p_N.x() / kEarthRadius;
  place.longitude = wrap(origin.longitude + p_N.y() / (kEarthRadius * std::cos(origin.latitude)));
  place.altitude = origin.altitude - p_N.z();
  return place;
}

}  // namespace ironbird::autopilot
