#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "autopilot/math/angles.hpp"
#include "autopilot/math/smoothstep.hpp"
#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// A point of a planned motion.
struct MotionPoint {
  Vector3 p_N = Vector3::Zero();
  Vector3 v_N = Vector3::Zero();
  Vector3 a_N = Vector3::Zero();
  double heading = 0.0;
  double heading_rate = 0.0;
  double heading_acceleration = 0.0;
  std::uint32_t passed = 0;
  bool ended = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin");
    visit("v_N", self.v_N, "m/s", "velocity");
    visit("a_N", self.a_N, "m/s^2", "acceleration");
    visit("heading", self.heading, "rad", "heading, (-pi, pi]");
    visit("heading_rate", self.heading_rate, "rad/s", "its rate");
    visit("heading_acceleration", self.heading_acceleration, "rad/s^2", "its second rate");
    visit("passed", self.passed, "1", "waypoints of the motion that lie behind this point");
    visit("ended", self.ended, "1", "the motion is over and rests");
  }
};

/// What a motion may ask of the vehicle.
struct MotionLimits {
  double max_velocity = 3.0;
  double max_acceleration = 2.5;
  double max_heading_rate = 1.0;
  double max_heading_acceleration = 2.0;
  double rise_time = 0.3;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("max_velocity", self.max_velocity, "m/s", "greatest speed along a leg", 0.01, 50.0);
    visit("max_acceleration", self.max_acceleration, "m/s^2", "greatest acceleration along a leg", 0.01,
          50.0);
    visit("max_heading_rate", self.max_heading_rate, "rad/s", "greatest heading rate", 0.01, 1e3);
    visit("max_heading_acceleration", self.max_heading_acceleration, "rad/s^2",
          "greatest second rate of the heading", 0.01, 1e6);
    visit("rise_time", self.rise_time, "s",
          "time in which the acceleration, or that of the heading, may grow to its greatest: it bounds the "
          "jerk; 0: at once",
          0.0, 10.0);
  }
};

/// What a smooth step from rest to rest lasts at least, s.
/// @param distance   m, >= 0
/// @param turn       rad, >= 0
/// @param max_speed  m/s, > 0; the least of it and the limit counts
inline double leg_duration(double distance, double turn, double max_speed, const MotionLimits& limits) {
  const double speed = std::min(max_speed, limits.max_velocity);
  return std::max(
      smoothstep_duration(distance, speed, limits.max_acceleration, limits.rise_time),
      smoothstep_duration(turn, limits.max_heading_rate, limits.max_heading_acceleration, limits.rise_time));
}

/// Comes to rest: the velocity is a cubic in tau that begins with velocity and acceleration of the motion
/// before and ends with none, the heading rate likewise. So position, velocity and acceleration are
/// continuous.
///
/// With A the greatest acceleration allowed, or that at the beginning when it is greater, it lasts no shorter
/// than 1.5 v0/(A - a0/3), with which none is exceeded; and so long that the acceleration changes by no more
/// than A in the rise time at either end, or a short brake would jerk the vehicle about.
class Brake {
 public:
  Brake() = default;

  /// Begins at `from` and ends at rest as soon as the limits allow.
  Brake(const MotionPoint& from, const MotionLimits& limits)
      : from_(from),
        duration_(
            std::max(shortest(from.v_N.norm(), from.a_N.norm(), limits.max_acceleration, limits.rise_time),
                     shortest(std::abs(from.heading_rate), std::abs(from.heading_acceleration),
                              limits.max_heading_acceleration, limits.rise_time))) {}

  MotionPoint evaluate(double elapsed) const {
    const double T = duration_;
    const double tau = T > 0.0 ? std::clamp(elapsed / T, 0.0, 1.0) : 1.0;
    // Shares of the velocity and of the acceleration at the beginning.
    const double way_v = T * tau * (1.0 + tau * tau * (0.5 * tau - 1.0));
    const double way_a = T * T * tau * tau * (0.5 + tau * (0.25 * tau - 2.0 / 3.0));
    const double speed_v = 1.0 + tau * tau * (2.0 * tau - 3.0);
    const double speed_a = T * tau * (1.0 + tau * (tau - 2.0));
    const double slowing_v = T > 0.0 ? 6.0 * tau * (tau - 1.0) / T : 0.0;
    const double slowing_a = T > 0.0 ? 1.0 + tau * (3.0 * tau - 4.0) : 0.0;
    MotionPoint point;
    point.p_N = from_.p_N + way_v * from_.v_N + way_a * from_.a_N;
    point.v_N = speed_v * from_.v_N + speed_a * from_.a_N;
    point.a_N = slowing_v * from_.v_N + slowing_a * from_.a_N;
    point.heading = wrap(from_.heading + way_v * from_.heading_rate + way_a * from_.heading_acceleration);
    point.heading_rate = speed_v * from_.heading_rate + speed_a * from_.heading_acceleration;
    point.heading_acceleration = slowing_v * from_.heading_rate + slowing_a * from_.heading_acceleration;
    point.ended = elapsed >= T;
    return point;
  }

  double duration() const { return duration_; }

 private:
  /// @param v0  m/s, >= 0
  /// @param a0  m/s^2, >= 0
  /// @param rise  s, >= 0
  static double shortest(double v0, double a0, double limit, double rise) {
    const double most = std::max(limit, a0);
    // 6 v0/T^2 + 4 a0/T, the greatest change of the acceleration, at the beginning, is most/rise
    const double begun = 2.0 * a0 * rise;
    const double smooth = (begun + std::sqrt(begun * begun + 6.0 * v0 * rise * most)) / most;
    return std::max(1.5 * v0 / (most - a0 / 3.0), smooth);
  }

  MotionPoint from_;
  double duration_ = 0.0;
};

}  // namespace ironbird::autopilot
