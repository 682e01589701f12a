#pragma once

#include <string>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::scenarios {

/// The earth's magnetic field at a place and time.
struct MagneticField {
  autopilot::Vector3 b_N = autopilot::Vector3::Zero();
  double declination = 0.0;
  double inclination = 0.0;
  double strength = 0.0;
  int edition = 0;
  bool current = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("b_N", self.b_N, "T", "flux density north, east, down");
    visit("declination", self.declination, "rad", "angle from true to magnetic north, east positive");
    visit("inclination", self.inclination, "rad", "below the horizon");
    visit("strength", self.strength, "T", "magnitude");
    visit("edition", self.edition, "1", "year of the World Magnetic Model that was taken");
    visit("current", self.current, "1", "the time lies in the five years that the edition is meant for");
  }
};

/// The field by the World Magnetic Model, of the edition that is meant for the time, or the nearest; a time
/// far from all editions is taken for the nearest that is within ten years.
///
/// Chulliat et al., The US/UK World Magnetic Model for 2025-2030, section 1.2 (equations 3 to 19): spherical
/// harmonics of degree 12 of the main field and its change. It knows nothing of iron in the ground: typically
/// 0.4 degrees of declination.
/// @param latitude, longitude  geodetic, WGS 84, rad
/// @param altitude  above the ellipsoid, m
/// @param year  decimal: 2024.5
MagneticField magnetic_field(double latitude, double longitude, double altitude, double year);

/// The decimal year from which on the newest edition is meant.
double newest_epoch();

/// The decimal year of a time. @param unix_time  s since 1970, UTC
double decimal_year(double unix_time);

}  // namespace ironbird::scenarios
