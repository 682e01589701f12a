#pragma once

#include <algorithm>
#include <cmath>

namespace ironbird::autopilot {

/// The quintic smooth step and its derivatives with respect to tau: it leads from 0 to 1 and begins and ends
/// with neither velocity nor acceleration. ROScopter paper, path manager.
struct Smoothstep {
  double value = 0.0;   ///< 6 tau^5 - 15 tau^4 + 10 tau^3
  double first = 0.0;   ///< its derivative, at most kPeakFirst
  double second = 0.0;  ///< its second derivative, at most kPeakSecond in size

  static constexpr double kPeakFirst = 1.875;                ///< at tau = 1/2
  static constexpr double kPeakSecond = 5.7735026918962576;  ///< 10/sqrt(3), at tau = 1/2 -+ sqrt(3)/6
  static constexpr double kPeakThird = 60.0;                 ///< at both ends; 60 (1 - 6 tau + 6 tau^2)

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("value", self.value, "1", "smooth step");
    visit("first", self.first, "1", "its derivative with respect to tau");
    visit("second", self.second, "1", "its second derivative with respect to tau");
  }
};

/// The smooth step at `tau`; outside [0, 1] it rests at its ends.
constexpr Smoothstep smoothstep(double tau) {
  const double t = std::clamp(tau, 0.0, 1.0);
  return {t * t * t * (10.0 + t * (6.0 * t - 15.0)), 30.0 * t * t * (1.0 + t * (t - 2.0)),
          60.0 * t * (1.0 + t * (2.0 * t - 3.0))};
}

/// The shortest time in which a smooth step covers `distance` within all limits, s; 0 when there is no
/// distance.
/// @param distance  m or rad, >= 0
/// @param max_rate  m/s or rad/s, > 0
/// @param max_acceleration  m/s^2 or rad/s^2, > 0
/// @param rise_time  in which the acceleration may grow to its greatest, s, >= 0; bounds the jerk
inline double smoothstep_duration(double distance, double max_rate, double max_acceleration,
                                  double rise_time) {
  return std::max({Smoothstep::kPeakFirst * distance / max_rate,
                   std::sqrt(Smoothstep::kPeakSecond * distance / max_acceleration),
                   std::cbrt(Smoothstep::kPeakThird * distance * rise_time / max_acceleration)});
}

}  // namespace ironbird::autopilot
