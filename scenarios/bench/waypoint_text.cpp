#include "scenarios/bench/waypoint_text.hpp"

#include <array>
#include <charconv>

#include "scenarios/config/degrees.hpp"

namespace ironbird::scenarios {

namespace {

constexpr int kCentimetre = 7;  // decimals of a degree of latitude

std::string rounded(double value, int decimals = 2) {
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  return {text.data(), end.ptr};
}

std::string place_of(const autopilot::Waypoint& waypoint) {
  if (waypoint.geodetic) {
    const autopilot::GeodeticPosition& where = *waypoint.geodetic;
    return "latitude " + rounded(where.latitude * kDegreesPerRadian, kCentimetre) + " deg, longitude " +
           rounded(where.longitude * kDegreesPerRadian, kCentimetre) + " deg, altitude " +
           rounded(where.altitude) + " m";
  }
  return "(" + rounded(waypoint.p_N.x()) + ", " + rounded(waypoint.p_N.y()) + ", " +
         rounded(waypoint.p_N.z()) + ") m";
}

}  // namespace

std::string line_about(const autopilot::Waypoint& waypoint, std::size_t index) {
  std::string line = std::to_string(index) + ": ";
  for (const auto& [value, name] : enumerators(waypoint.kind)) {
    if (value == waypoint.kind) line += name;
  }
  line += " at " + place_of(waypoint) + ", heading " + rounded(waypoint.heading * kDegreesPerRadian) + " deg";
  if (waypoint.speed > 0.0) line += ", at most " + rounded(waypoint.speed) + " m/s";
  if (waypoint.kind != autopilot::WaypointKind::kHold) return line;
  return line +
         (waypoint.hold_indefinitely ? ", until released" : ", for " + rounded(waypoint.hold_time) + " s");
}

}  // namespace ironbird::scenarios
