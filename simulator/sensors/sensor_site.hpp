#pragma once

#include "simulator/environment/air.hpp"
#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Radius, m, of the sphere on which positions become latitudes and longitudes. The one the autopilot uses:
/// with another the simulator would stretch the map.
inline constexpr double kEarthRadius = 6378145.0;

/// Where the local origin is and what surrounds it: all that the sensors know of the environment.
struct SensorSite {
  double latitude = 0.7024317104;
  double longitude = -1.9486149720;
  double altitude = 1387.0;
  double gravity = 9.80665;
  Vector3 magnetic_field_N = {20.84e-6, 3.92e-6, 46.07e-6};
  AirParams air;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("latitude", self.latitude, "rad", "of the local origin, north positive", -1.5707963267948966,
          1.5707963267948966);
    visit("longitude", self.longitude, "rad", "of the local origin, east positive", -3.1415926535897931,
          3.1415926535897931);
    visit("altitude", self.altitude, "m", "of the local origin above mean sea level", -500.0, 9000.0);
    visit("gravity", self.gravity, "m/s^2", "along +Nz", 0.0, 20.0);
    visit("magnetic_field_N", self.magnetic_field_N, "T", "the earth's field");
    visit("air", self.air, "", "pressure and temperature of the day");
  }
};

}  // namespace ironbird::simulator
