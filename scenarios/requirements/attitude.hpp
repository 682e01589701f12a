#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace ironbird::scenarios {

// The judge's own angles, so that a mistake in the autopilot's is not judged by itself.

/// ZYX angles of the attitude `q_NB`, rad.
struct EulerAngles {
  double roll = 0.0;
  double pitch = 0.0;
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("roll", self.roll, "rad", "about Bx");
    visit("pitch", self.pitch, "rad", "nose up");
    visit("heading", self.heading, "rad", "from north to east");
  }
};

inline double roll_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()), 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()));
}
inline double pitch_of(const Eigen::Quaterniond& q) {
  return std::asin(std::clamp(2.0 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0));
}
inline double heading_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}
inline EulerAngles euler_of(const Eigen::Quaterniond& q) {
  return {roll_of(q), pitch_of(q), heading_of(q)};
}

/// Angle between Bz and Nz, rad.
inline double tilt_of(const Eigen::Quaterniond& q) {
  return std::acos(std::clamp(1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()), -1.0, 1.0));
}

/// The same angle in (-pi, pi], rad.
inline double wrapped(double angle) {
  const double turned = std::remainder(angle, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

/// The angle of the turn that takes attitude `a` to attitude `b`, rad, 0..pi.
inline double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond turn = a.conjugate() * b;
  return 2.0 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace ironbird::scenarios
