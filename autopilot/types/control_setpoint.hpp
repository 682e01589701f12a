#pragma once

#include <variant>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

// The twelve entry points of the controller (ROScopter paper, controller table). The number of an entry is
// its index in ControlSetpoint. Throttle is 0..1 of what the FCU can give; thrust is newtons along -Bz,
// positive up. The bounds keep slips out of setpoints that a file gives; nothing enforces them in flight.

/// A whole turn, rad.
inline constexpr double kTurn = 6.283185307179586;

/// Entry 0: hold a position and a heading.
struct PositionHeading {
  Vector3 p_N = Vector3::Zero();
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position from the local origin", -1e5, 1e5);
    visit("heading", self.heading, "rad", "heading", -kTurn, kTurn);
  }
};

/// Entry 1: horizontal velocity, height, heading rate.
struct VelocityHeightHeadingRate {
  Vector2 v_N = Vector2::Zero();
  double down = 0.0;
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("v_N", self.v_N, "m/s", "velocity north and east", -200.0, 200.0);
    visit("down", self.down, "m", "position down", -1e4, 1e4);
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate", -100.0, 100.0);
  }
};

/// Entry 2: acceleration in V (N turned by heading), heading rate.
struct AccelerationHeadingRate {
  Vector3 a_V = Vector3::Zero();
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("a_V", self.a_V, "m/s^2", "acceleration forward, right, down", -500.0, 500.0);
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate", -100.0, 100.0);
  }
};

/// Entry 3: velocity, heading rate.
struct VelocityHeadingRate {
  Vector3 v_N = Vector3::Zero();
  double heading_rate = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("v_N", self.v_N, "m/s", "velocity", -200.0, 200.0);
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate", -100.0, 100.0);
  }
};

/// Entry 4: horizontal position, vertical velocity, heading.
struct PositionClimbHeading {
  Vector2 p_N = Vector2::Zero();
  double v_down = 0.0;
  double heading = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("p_N", self.p_N, "m", "position north and east", -1e5, 1e5);
    visit("v_down", self.v_down, "m/s", "velocity down", -200.0, 200.0);
    visit("heading", self.heading, "rad", "heading", -kTurn, kTurn);
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
    visit("roll", self.roll, "rad", "roll angle", -kTurn, kTurn);
    visit("pitch", self.pitch, "rad", "pitch angle", -kTurn, kTurn);
    visit("heading", self.heading, "rad", "heading", -kTurn, kTurn);
    visit("throttle", self.throttle, "1", "share of what the FCU can give", 0.0, 1.0);
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
    visit("roll", self.roll, "rad", "roll angle", -kTurn, kTurn);
    visit("pitch", self.pitch, "rad", "pitch angle", -kTurn, kTurn);
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate", -100.0, 100.0);
    visit("throttle", self.throttle, "1", "share of what the FCU can give", 0.0, 1.0);
  }
};

/// Entry 7: body rates and throttle.
struct RateThrottle {
  Vector3 w_NB_B = Vector3::Zero();
  double throttle = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity", -100.0, 100.0);
    visit("throttle", self.throttle, "1", "share of what the FCU can give", 0.0, 1.0);
  }
};

/// Entry 8: torque and thrust.
struct TorqueThrust {
  Vector3 M_B = Vector3::Zero();
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("M_B", self.M_B, "N*m", "torque about the centre of mass", -1e4, 1e4);
    visit("thrust", self.thrust, "N", "thrust along -Bz", -1e5, 1e5);
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
    visit("roll", self.roll, "rad", "roll angle", -kTurn, kTurn);
    visit("pitch", self.pitch, "rad", "pitch angle", -kTurn, kTurn);
    visit("heading", self.heading, "rad", "heading", -kTurn, kTurn);
    visit("thrust", self.thrust, "N", "thrust along -Bz", -1e5, 1e5);
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
    visit("roll", self.roll, "rad", "roll angle", -kTurn, kTurn);
    visit("pitch", self.pitch, "rad", "pitch angle", -kTurn, kTurn);
    visit("heading_rate", self.heading_rate, "rad/s", "yaw rate", -100.0, 100.0);
    visit("thrust", self.thrust, "N", "thrust along -Bz", -1e5, 1e5);
  }
};

/// Entry 11: body rates and thrust.
struct RateThrust {
  Vector3 w_NB_B = Vector3::Zero();
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity", -100.0, 100.0);
    visit("thrust", self.thrust, "N", "thrust along -Bz", -1e5, 1e5);
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
