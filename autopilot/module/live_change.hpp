#pragma once

namespace ironbird::autopilot {

// How far a parameter may go from what was configured while the vehicle flies.

/// What the model of the vehicle says: better known than to a quarter.
inline constexpr double kLittle = 1.25;
/// Gains and limits of loops.
inline constexpr double kMuch = 3.0;

/// `now` lies between a `factor` less and a `factor` more than `configured`.
constexpr bool stays(double now, double configured, double factor) {
  return now >= configured / factor && now <= configured * factor;
}

/// `now` is not less than `least`, unless that was configured.
constexpr bool stays_above(double now, double configured, double least) {
  return now >= least || now >= configured;
}

/// `now` is not more than `most`, unless that was configured.
constexpr bool stays_below(double now, double configured, double most) {
  return now <= most || now <= configured;
}

}  // namespace ironbird::autopilot
