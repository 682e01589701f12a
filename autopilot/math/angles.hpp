#pragma once

#include <cmath>
#include <numbers>

namespace ironbird::autopilot {

/// The same angle in (-pi, pi], rad.
inline double wrap(double angle) {
  if (std::abs(angle) < std::numbers::pi) return angle;
  const double turned = std::remainder(angle, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

/// The shortest way from angle `from` to angle `to`, rad, in (-pi, pi].
inline double shortest_difference(double to, double from) {
  return wrap(to - from);
}

/// `angle` moved by whole turns to within half a turn of `reference`, rad.
inline double unwrap_near(double angle, double reference) {
  return reference + wrap(angle - reference);
}

}  // namespace ironbird::autopilot
