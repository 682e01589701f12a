#pragma once

#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/fcu_command.hpp"
#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/sensor_frame.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "autopilot/types/trajectory_point.hpp"

namespace ironbird::autopilot {

/// Every quantity that a tick computes. Each member is a topic of the log; a new member is a new topic.
struct Signals {
  SensorFrame sensors;
  FlightStatus flight;
  StateEstimate estimate;
  Route route;
  TrajectoryPoint trajectory;
  ControlSetpoint setpoint = NoSetpoint{};
  FcuCommand command = SilenceCommand{};
  Time external_pose_heard{-1};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("sensors", self.sensors, "", "what the FCU reported since the tick before");
    visit("flight", self.flight, "", "who flies, in which phase");
    visit("estimate", self.estimate, "", "where the vehicle is");
    visit("route", self.route, "", "the waypoints in force");
    visit("trajectory", self.trajectory, "", "where the vehicle should be");
    visit("setpoint", self.setpoint, "", "what the controller was asked for");
    visit("command", self.command, "", "what the FCU was told");
    visit("external_pose_heard", self.external_pose_heard, "ns",
          "stamp of the frame with the newest pose from outside; negative: there was none");
  }
};

}  // namespace ironbird::autopilot
