#pragma once

#include <variant>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

// The three commands that a ROSflight FCU takes, and saying nothing.

/// Force and torque for the mixer: all loops are the companion's.
struct PassThroughCommand {
  Vector3 M_B = Vector3::Zero();
  double thrust = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("M_B", self.M_B, "N*m", "torque about the centre of mass");
    visit("thrust", self.thrust, "N", "thrust along -Bz, positive up");
  }
};

/// Body rates and throttle: the FCU closes the rate loop.
struct RateCommand {
  Vector3 w_NB_B = Vector3::Zero();
  double throttle = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
    visit("throttle", self.throttle, "1", "0..1");
  }
};

/// Roll, pitch, yaw rate and throttle: the FCU closes the angle loop.
struct AngleCommand {
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

/// Nothing is sent; the FCU's own time-out and the pilot decide.
struct SilenceCommand {
  template <class Self, class Visit>
  static void describe(Self&, Visit&&) {}
};

using FcuCommand = std::variant<SilenceCommand, PassThroughCommand, RateCommand, AngleCommand>;

}  // namespace ironbird::autopilot
