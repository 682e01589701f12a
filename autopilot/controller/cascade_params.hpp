#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "autopilot/math/pid.hpp"
#include "autopilot/module/live_change.hpp"

namespace ironbird::autopilot {

/// Gains and limits of the cascade. Gains of the torque loops: the robust set tuned for the X650 with matched
/// thrust.
struct CascadeParams {
  double mass = 3.9;
  double gravity = 9.81;
  double derivative_time_constant = 0.05;
  int acceleration_output = 1;
  double equilibrium_throttle = 0.5;
  double min_throttle = 0.05;
  double max_throttle = 0.95;
  double min_thrust = 2.0;
  double max_thrust = 80.0;
  double max_roll = 0.7;
  double max_pitch = 0.7;
  double max_roll_rate = 4.0;
  double max_pitch_rate = 4.0;
  double max_yaw_rate = 2.0;
  double max_roll_torque = 5.0;
  double max_pitch_torque = 5.0;
  double max_yaw_torque = 1.0;
  double max_horizontal_speed = 5.0;
  double max_climb_speed = 3.0;
  double max_descent_speed = 2.0;
  double max_horizontal_acceleration = 5.0;
  double max_climb_acceleration = 8.0;
  double max_descent_acceleration = 5.0;
  double min_altitude_for_attitude_control = 0.0;
  PidGains pos_n_to_vel{1.0, 0.0, 0.0};
  PidGains pos_e_to_vel{1.0, 0.0, 0.0};
  PidGains pos_d_to_vel{1.2, 0.0, 0.0};
  PidGains vel_n_to_accel{2.2, 0.3, 0.0};
  PidGains vel_e_to_accel{2.2, 0.3, 0.0};
  PidGains vel_d_to_accel{4.0, 1.0, 0.0};
  PidGains yaw_to_rate{3.3, 0.0, 0.25};
  PidGains roll_to_torque{3.89, 0.47, 0.76};
  PidGains pitch_to_torque{3.89, 0.47, 0.76};
  PidGains yaw_to_torque{2.0, 0.02, 1.0};
  PidGains roll_rate_to_torque{0.76, 0.5, 0.0};
  PidGains pitch_rate_to_torque{0.76, 0.5, 0.0};
  PidGains yaw_rate_to_torque{0.49, 0.0, 0.0};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("mass", self.mass, "kg", "mass of the vehicle", 0.05, 100.0);
    visit("gravity", self.gravity, "m/s^2", "gravitational acceleration", 1.0, 30.0);
    visit("derivative_time_constant", self.derivative_time_constant, "s", "filter of the derivatives", 1e-3,
          1.0);
    visit("acceleration_output", self.acceleration_output, "1",
          "entries 0 to 4 become: 0 angles and throttle for the FCU, 1 torque and thrust", 0.0, 1.0);
    describe_limits(self, visit);
    describe_gains(self, visit);
  }

  static std::string_view conflict(const CascadeParams& p) {
    if (p.min_throttle >= p.max_throttle) return "min_throttle must be less than max_throttle";
    if (p.min_thrust >= p.max_thrust) return "min_thrust must be less than max_thrust";
    return {};
  }

  static std::string_view danger(const CascadeParams& was, const CascadeParams& now) {
    const double weight = was.mass * was.gravity;  // N
    if (!stays(now.mass, was.mass, kLittle) || !stays(now.gravity, was.gravity, kLittle) ||
        !stays(now.equilibrium_throttle, was.equilibrium_throttle, kLittle)) {
      return "mass, gravity and equilibrium_throttle must stay within a quarter of what was configured";
    }
    if (!stays_above(now.max_thrust, was.max_thrust, 1.3 * weight) ||
        !stays_above(now.max_throttle, was.max_throttle, 1.15 * was.equilibrium_throttle)) {
      return "max_thrust and max_throttle must leave enough to climb";
    }
    if (!stays_below(now.min_thrust, was.min_thrust, 0.5 * weight) ||
        !stays_below(now.min_throttle, was.min_throttle, 0.7 * was.equilibrium_throttle)) {
      return "min_thrust and min_throttle must leave enough to sink";
    }
    if (now.min_altitude_for_attitude_control > was.min_altitude_for_attitude_control) {
      return "min_altitude_for_attitude_control must not grow";
    }
    if (!steerable(was, now)) {
      return "torques, gains and derivative_time_constant must stay within a third and three times what was "
             "configured";
    }
    if (now.acceleration_output != was.acceleration_output) return "acceleration_output must stay as it is";
    if (!stays_below(now.max_roll, was.max_roll, 1.0) || !stays_below(now.max_pitch, was.max_pitch, 1.0)) {
      return "max_roll and max_pitch must stay below 1 rad";
    }
    if (!stays_above(now.max_climb_speed, was.max_climb_speed, 0.5) ||
        !stays_above(now.max_descent_speed, was.max_descent_speed, 0.5)) {
      return "max_climb_speed and max_descent_speed must stay above 0.5 m/s";
    }
    const bool brakes = stays_above(now.max_climb_acceleration, was.max_climb_acceleration, 2.0) &&
                        stays_above(now.max_descent_acceleration, was.max_descent_acceleration, 1.0);
    return brakes ? "" : "max_climb_acceleration and max_descent_acceleration must stay above 2 and 1 m/s^2";
  }

 private:
  static bool stay(const PidGains& now, const PidGains& was, double factor) {
    return stays(now.kp, was.kp, factor) && stays(now.ki, was.ki, factor) && stays(now.kd, was.kd, factor);
  }

  static bool steerable(const CascadeParams& was, const CascadeParams& now) {
    constexpr std::array kGains{&CascadeParams::pos_n_to_vel,        &CascadeParams::pos_e_to_vel,
                                &CascadeParams::pos_d_to_vel,        &CascadeParams::vel_n_to_accel,
                                &CascadeParams::vel_e_to_accel,      &CascadeParams::vel_d_to_accel,
                                &CascadeParams::yaw_to_rate,         &CascadeParams::roll_to_torque,
                                &CascadeParams::pitch_to_torque,     &CascadeParams::yaw_to_torque,
                                &CascadeParams::roll_rate_to_torque, &CascadeParams::pitch_rate_to_torque,
                                &CascadeParams::yaw_rate_to_torque};
    constexpr std::array kLimits{&CascadeParams::max_roll_torque, &CascadeParams::max_pitch_torque,
                                 &CascadeParams::max_yaw_torque, &CascadeParams::derivative_time_constant};
    return std::all_of(kGains.begin(), kGains.end(),
                       [&](auto gains) { return stay(now.*gains, was.*gains, kMuch); }) &&
           std::all_of(kLimits.begin(), kLimits.end(),
                       [&](auto limit) { return stays(now.*limit, was.*limit, kMuch); });
  }

  template <class Self, class Visit>
  static void describe_limits(Self& self, Visit& visit) {
    visit("equilibrium_throttle", self.equilibrium_throttle, "1", "throttle that carries the weight", 0.05,
          1.0);
    visit("min_throttle", self.min_throttle, "1", "least throttle", 0.0, 1.0);
    visit("max_throttle", self.max_throttle, "1", "greatest throttle", 0.0, 1.0);
    visit("min_thrust", self.min_thrust, "N", "least thrust", 0.0, 1e4);
    visit("max_thrust", self.max_thrust, "N", "greatest thrust", 0.1, 1e4);
    visit("max_roll", self.max_roll, "rad", "greatest roll angle", 0.01, 1.55);
    visit("max_pitch", self.max_pitch, "rad", "greatest pitch angle", 0.01, 1.55);
    visit("max_roll_rate", self.max_roll_rate, "rad/s", "greatest roll rate", 0.01, 100.0);
    visit("max_pitch_rate", self.max_pitch_rate, "rad/s", "greatest pitch rate", 0.01, 100.0);
    visit("max_yaw_rate", self.max_yaw_rate, "rad/s", "greatest yaw rate", 0.01, 100.0);
    visit("max_roll_torque", self.max_roll_torque, "N*m", "greatest roll torque", 0.0, 1e3);
    visit("max_pitch_torque", self.max_pitch_torque, "N*m", "greatest pitch torque", 0.0, 1e3);
    visit("max_yaw_torque", self.max_yaw_torque, "N*m", "greatest yaw torque", 0.0, 1e3);
    visit("max_horizontal_speed", self.max_horizontal_speed, "m/s", "greatest horizontal speed", 0.1, 1e3);
    visit("max_climb_speed", self.max_climb_speed, "m/s", "greatest speed upwards", 0.1, 1e3);
    visit("max_descent_speed", self.max_descent_speed, "m/s", "greatest speed downwards", 0.1, 1e3);
    visit("max_horizontal_acceleration", self.max_horizontal_acceleration, "m/s^2",
          "greatest horizontal acceleration", 0.1, 1e3);
    visit("max_climb_acceleration", self.max_climb_acceleration, "m/s^2", "greatest acceleration upwards",
          0.1, 1e3);
    visit("max_descent_acceleration", self.max_descent_acceleration, "m/s^2",
          "greatest acceleration downwards", 0.1, 9.0);
    visit("min_altitude_for_attitude_control", self.min_altitude_for_attitude_control, "m",
          "nearer than this to the origin's height no torque is asked for; 0: always", 0.0, 10.0);
  }

  template <class Self, class Visit>
  static void describe_gains(Self& self, Visit& visit) {
    visit("pos_n_to_vel", self.pos_n_to_vel, "", "position north to velocity");
    visit("pos_e_to_vel", self.pos_e_to_vel, "", "position east to velocity");
    visit("pos_d_to_vel", self.pos_d_to_vel, "", "position down to velocity");
    visit("vel_n_to_accel", self.vel_n_to_accel, "", "velocity north to acceleration");
    visit("vel_e_to_accel", self.vel_e_to_accel, "", "velocity east to acceleration");
    visit("vel_d_to_accel", self.vel_d_to_accel, "", "velocity down to acceleration");
    visit("yaw_to_rate", self.yaw_to_rate, "", "heading to yaw rate");
    visit("roll_to_torque", self.roll_to_torque, "", "roll angle to torque");
    visit("pitch_to_torque", self.pitch_to_torque, "", "pitch angle to torque");
    visit("yaw_to_torque", self.yaw_to_torque, "", "heading to torque");
    visit("roll_rate_to_torque", self.roll_rate_to_torque, "", "roll rate to torque");
    visit("pitch_rate_to_torque", self.pitch_rate_to_torque, "", "pitch rate to torque");
    visit("yaw_rate_to_torque", self.yaw_rate_to_torque, "", "yaw rate to torque");
  }
};

}  // namespace ironbird::autopilot
