#pragma once

#include <cstdint>
#include <optional>

#include "autopilot/types/linear_algebra.hpp"
#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// Where the vehicle should be now, with the derivatives that the follower feeds forward.
struct TrajectoryPoint {
  Time stamp{};
  bool valid = false;
  Vector3 p_N = Vector3::Zero();
  Vector3 v_N = Vector3::Zero();
  Vector3 a_N = Vector3::Zero();
  double heading = 0.0;
  double heading_rate = 0.0;
  double heading_acceleration = 0.0;
  std::uint32_t leg = 0;
  std::uint32_t reached = 0;
  bool at_waypoint = false;
  bool holding = false;
  std::optional<double> hold_left;
  bool paused = false;
  std::optional<double> pause_left;
  bool finished = false;
  bool landing = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "when the vehicle should be there");
    visit("valid", self.valid, "1", "there is something to fly");
    visit("p_N", self.p_N, "m", "position from the local origin");
    visit("v_N", self.v_N, "m/s", "velocity");
    visit("a_N", self.a_N, "m/s^2", "acceleration");
    visit("heading", self.heading, "rad", "heading, (-pi, pi]");
    visit("heading_rate", self.heading_rate, "rad/s", "its rate");
    visit("heading_acceleration", self.heading_acceleration, "rad/s^2", "its second rate");
    visit("leg", self.leg, "1", "index of the waypoint that the leg ends at");
    visit("reached", self.reached, "1", "waypoints reached since the route began");
    visit("at_waypoint", self.at_waypoint, "1", "that waypoint is among those reached");
    visit("holding", self.holding, "1", "waiting, at a hold waypoint or on the spot");
    visit("hold_left", self.hold_left, "s",
          "what is left of the hold at this waypoint; none: until released");
    visit("paused", self.paused, "1", "a hold on the spot was asked for and is not over");
    visit("pause_left", self.pause_left, "s", "what is left of that hold; none: until released");
    visit("finished", self.finished, "1", "the last waypoint has been reached");
    visit("landing", self.landing, "1", "descend here and disarm on the ground");
  }
};

}  // namespace ironbird::autopilot
