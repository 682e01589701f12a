#pragma once

#include <string_view>

#include "autopilot/math/pid.hpp"
#include "autopilot/module/live_change.hpp"
#include "autopilot/module/tunable.hpp"
#include "autopilot/trajectory_follower/trajectory_follower.hpp"

namespace ironbird::autopilot {

/// Constants of the flat PID follower. The gains are the robust set tuned for the X650 with matched thrust.
struct FlatPidFollowerParams {
  double mass = 3.9;
  double gravity = 9.81;
  double derivative_time_constant = 0.05;
  PidGains north{3.43, 0.014, 2.23};
  PidGains east{3.43, 0.014, 2.23};
  PidGains down{12.1, 0.024, 9.16};
  PidGains heading{3.3, 0.0, 0.25};
  double drag = 0.0;
  bool use_velocity_reference = true;
  double down_command_window = 3.0;
  double min_lift = 3.924;
  double max_tilt = 0.6;
  double min_thrust = 4.0;
  double max_thrust = 80.0;
  double max_heading_rate = 2.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("mass", self.mass, "kg", "mass of the vehicle", 0.05, 100.0);
    visit("gravity", self.gravity, "m/s^2", "gravitational acceleration", 1.0, 30.0);
    visit("derivative_time_constant", self.derivative_time_constant, "s",
          "filter of the heading's derivative", 1e-3, 1.0);
    visit("north", self.north, "", "position north to acceleration");
    visit("east", self.east, "", "position east to acceleration");
    visit("down", self.down, "", "position down to acceleration");
    visit("heading", self.heading, "", "heading to heading rate");
    visit("drag", self.drag, "1/s",
          "deceleration by the air per horizontal speed of the trajectory, made up for", 0.0, 10.0);
    visit("use_velocity_reference", self.use_velocity_reference, "1",
          "kd acts on the velocity error; false: on the velocity");
    visit("down_command_window", self.down_command_window, "m",
          "how far below itself the vehicle may be sent", 0.1, 1e6);
    visit("min_lift", self.min_lift, "m/s^2", "least upward specific force", 0.1, 30.0);
    visit("max_tilt", self.max_tilt, "rad", "greatest tilt", 0.05, 1.55);
    visit("min_thrust", self.min_thrust, "N", "least thrust", 0.0, 1e4);
    visit("max_thrust", self.max_thrust, "N", "greatest thrust", 0.1, 1e4);
    visit("max_heading_rate", self.max_heading_rate, "rad/s", "greatest yaw rate", 0.05, 100.0);
  }

  static std::string_view conflict(const FlatPidFollowerParams& p) {
    if (p.min_thrust >= p.max_thrust) return "min_thrust must be less than max_thrust";
    return {};
  }

  static std::string_view danger(const FlatPidFollowerParams& was, const FlatPidFollowerParams& now) {
    const double weight = was.mass * was.gravity;  // N
    if (!stays(now.mass, was.mass, kLittle) || !stays(now.gravity, was.gravity, kLittle)) {
      return "mass and gravity must stay within a quarter of what was configured";
    }
    if (!stays_above(now.max_thrust, was.max_thrust, 1.3 * weight)) {
      return "max_thrust must leave enough to climb";
    }
    if (!stays_below(now.min_thrust, was.min_thrust, 0.5 * weight) ||
        !stays_below(now.min_lift, was.min_lift, 0.5 * was.gravity)) {
      return "min_thrust and min_lift must leave enough to sink";
    }
    const auto near = [](const PidGains& a, const PidGains& b) {
      return stays(a.kp, b.kp, kMuch) && stays(a.ki, b.ki, kMuch) && stays(a.kd, b.kd, kMuch);
    };
    return near(now.north, was.north) && near(now.east, was.east) && near(now.down, was.down)
               ? ""
               : "gains of the position must stay within a third and three times what was configured";
  }
};

/// PID on the position in N with velocity and acceleration of the trajectory fed forward, turned into
/// attitude and thrust by differential flatness. ROScopter paper, trajectory follower. With `drag` the
/// deceleration that the trajectory's speed causes in still air is fed forward as well.
///
/// Limits limit: lift, tilt, then the thrust window, which gives up horizontal force before vertical. It does
/// not feed jerk forward.
class FlatPidFollower final : public Tunable<TrajectoryFollower, FlatPidFollowerParams> {
 public:
  FlatPidFollower() { on_parameters(); }

  void reset() override;
  /// Goes on from the specific force that was asked for last; the heading has no integral worth keeping.
  void take_over(const Handover& left) override;
  void probe(ProbeVisitor& visit) const override;

 protected:
  void on_parameters() override;
  ControlSetpoint track(const TrajectoryPoint& point, const StateEstimate& estimate,
                        const FlightStatus& flight, double dt) override;

 private:
  Vector3 acceleration(const TrajectoryPoint& point, const StateEstimate& estimate, double dt,
                       bool integrate);
  double heading_rate(const TrajectoryPoint& point, const StateEstimate& estimate, double dt, bool integrate);
  void reset_integrals();
  Vector3 position_error(const TrajectoryPoint& point, const StateEstimate& estimate) const;
  Vector3 rate(const TrajectoryPoint& point, const StateEstimate& estimate) const;
  Vector3 fed_forward(const TrajectoryPoint& point) const;

  Pid north_;
  Pid east_;
  Pid down_;
  Pid heading_;
  double unwrapped_heading_ = 0.0;
  double tan_max_tilt_ = 0.0;
  Vector3 specific_force_N_ = Vector3::Zero();
};

}  // namespace ironbird::autopilot
