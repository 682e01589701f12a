#pragma once

#include <variant>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

// The twelve entry points of the controller (ROScopter paper, controller table). The number of an entry is
// its index in ControlSetpoint. Throttle is 0..1 of what the FCU can give; thrust is newtons along -Bz,
// positive up.

/// Entry 0: hold a position and a heading.
struct PositionHeading {
  Vector3 p_N = Vector3::Zero();
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin");
    visit("heading", self.heading, "rad", "heading");
  }
};

/// Entry 1: horizontal velocity, height, heading rate.
struct VelocityHeightHeadingRate {
  Vector2 v_N = Vector2::Zero();
  double down = 0.0;
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("v_N", self.v_N, "m/s", "velocity north and east");
    visit("down", self.down, "m", "position down");
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate");
  }
};

/// Entry 2: acceleration in V (N turned by heading), heading rate.
struct AccelerationHeadingRate {
  Vector3 a_V = Vector3::Zero();
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("a_V", self.a_V, "m/s^2", "acceleration forward, right, down");
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate");
  }
};

/// Entry 3: velocity, heading rate.
struct VelocityHeadingRate {
  Vector3 v_N = Vector3::Zero();
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("v_N", self.v_N, "m/s", "velocity");
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate");
  }
};

/// Entry 4: horizontal position, vertical velocity, heading.
struct PositionClimbHeading {
  Vector2 p_N = Vector2::Zero();
  double v_down = 0.0;
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position north and east");
    visit("v_down", self.v_down, "m/s", "velocity down");
    visit("heading", self.heading, "rad", "heading");
  }
};

/// Entry 5: attitude and throttle.
struct AngleHeadingThrottle {
  double roll = 0.0;
  double pitch = 0.0;
  double heading = 0.0;
  double throttle = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("roll", self.roll, "rad", "roll angle");
    visit("pitch", self.pitch, "rad", "pitch angle");
    visit("heading", self.heading, "rad", "heading");
    visit("throttle", self.throttle, "1", "0..1");
  }
};

/// Entry 6: roll, pitch, yaw rate and throttle.
struct AngleHeadingRateThrottle {
  double roll = 0.0;
  double pitch = 0.0;
  double heading_rate = 0.0;
  double throttle = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("roll", self.roll, "rad", "roll angle");
    visit("pitch", self.pitch, "rad", "pitch angle");
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate");
    visit("throttle", self.throttle, "1", "0..1");
  }
};

/// Entry 7: body rates and throttle.
struct RateThrottle {
  Vector3 w_NB_B = Vector3::Zero();
  double throttle = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
    visit("throttle", self.throttle, "1", "0..1");
  }
};

/// Entry 8: torque and thrust.
struct TorqueThrust {
  Vector3 M_B = Vector3::Zero();
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("M_B", self.M_B, "N*m", "torque about the centre of mass");
    visit("thrust", self.thrust, "N", "thrust along -Bz");
  }
};

/// Entry 9: attitude and thrust.
struct AngleHeadingThrust {
  double roll = 0.0;
  double pitch = 0.0;
  double heading = 0.0;
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("roll", self.roll, "rad", "roll angle");
    visit("pitch", self.pitch, "rad", "pitch angle");
    visit("heading", self.heading, "rad", "heading");
    visit("thrust", self.thrust, "N", "thrust along -Bz");
  }
};

/// Entry 10: roll, pitch, yaw rate and thrust. What the trajectory follower asks for.
struct AngleHeadingRateThrust {
  double roll = 0.0;
  double pitch = 0.0;
  double heading_rate = 0.0;
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("roll", self.roll, "rad", "roll angle");
    visit("pitch", self.pitch, "rad", "pitch angle");
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate");
    visit("thrust", self.thrust, "N", "thrust along -Bz");
  }
};

/// Entry 11: body rates and thrust.
struct RateThrust {
  Vector3 w_NB_B = Vector3::Zero();
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
    visit("thrust", self.thrust, "N", "thrust along -Bz");
  }
};

/// Nothing to fly: the follower has no valid setpoint.
struct NoSetpoint {
  template <class Self, class Visit>
  static void describe(Self&, Visit&&) {}
};

using ControlSetpoint =
    std::variant<PositionHeading, VelocityHeightHeadingRate, AccelerationHeadingRate, VelocityHeadingRate,
                 PositionClimbHeading, AngleHeadingThrottle, AngleHeadingRateThrottle, RateThrottle,
                 TorqueThrust, AngleHeadingThrust, AngleHeadingRateThrust, RateThrust, NoSetpoint>;

}  // namespace ironbird::autopilot
