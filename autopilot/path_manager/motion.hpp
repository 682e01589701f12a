#pragma once

#include <algorithm>
#include <cstdint>

#include "autopilot/math/angles.hpp"
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

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("max_velocity", self.max_velocity, "m/s", "greatest speed along a leg", 0.01, 50.0);
    visit("max_acceleration", self.max_acceleration, "m/s^2", "greatest acceleration along a leg", 0.01,
          50.0);
    visit("max_heading_rate", self.max_heading_rate, "rad/s", "greatest heading rate", 0.01, 1e3);
    visit("max_heading_acceleration", self.max_heading_acceleration, "rad/s^2",
          "greatest second rate of the heading", 0.01, 1e6);
  }
};

/// Comes to rest along a straight line: v = v0 (1 - 3 tau^2 + 2 tau^3), the heading rate likewise. Position
/// and velocity are continuous; the acceleration is 0 at both ends.
class Brake {
 public:
  Brake() = default;

  /// Begins at `from` and ends at rest as soon as the limits on acceleration allow.
  Brake(const MotionPoint& from, const MotionLimits& limits)
      : from_(from),
        duration_(kPeakSlope * std::max(from.v_N.norm() / limits.max_acceleration,
                                        std::abs(from.heading_rate) / limits.max_heading_acceleration)) {}

  MotionPoint evaluate(double elapsed) const {
    const double tau = duration_ > 0.0 ? std::clamp(elapsed / duration_, 0.0, 1.0) : 1.0;
    const double way = duration_ * tau * (1.0 + tau * tau * (0.5 * tau - 1.0));
    const double speed = 1.0 + tau * tau * (2.0 * tau - 3.0);
    const double slowing = duration_ > 0.0 ? 6.0 * tau * (tau - 1.0) / duration_ : 0.0;
    MotionPoint point;
    point.p_N = from_.p_N + way * from_.v_N;
    point.v_N = speed * from_.v_N;
    point.a_N = slowing * from_.v_N;
    point.heading = wrap(from_.heading + way * from_.heading_rate);
    point.heading_rate = speed * from_.heading_rate;
    point.heading_acceleration = slowing * from_.heading_rate;
    point.ended = elapsed >= duration_;
    return point;
  }

  double duration() const { return duration_; }

 private:
  static constexpr double kPeakSlope = 1.5;  // of 3 tau^2 - 2 tau^3, at tau = 1/2

  MotionPoint from_;
  double duration_ = 0.0;
};

}  // namespace ironbird::autopilot
