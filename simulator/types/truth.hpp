#pragma once

#include <array>

#include "simulator/types/linear_algebra.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/types/time.hpp"

namespace ironbird::simulator {

/// What really is. Read by sensors, recorder, checks and renderer; never by the autopilot.
struct Truth {
  Time stamp{};
  Vector3 p_NB_N = Vector3::Zero();
  Quaternion q_NB = Quaternion::Identity();
  Vector3 v_NB_N = Vector3::Zero();
  Vector3 w_NB_B = Vector3::Zero();
  Vector3 f_B = Vector3::Zero();
  Vector3 w_dot_NB_B = Vector3::Zero();
  Vector3 wind_N = Vector3::Zero();
  double air_density = 1.225;
  std::array<double, kMaxRotors> rotor_speed{};
  double battery_voltage = 0.0;
  double battery_current = 0.0;
  double battery_charge_used = 0.0;
  bool in_contact = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stamp", self.stamp, "ns", "simulated time");
    visit("p_NB_N", self.p_NB_N, "m", "position of the centre of mass from the local origin");
    visit("q_NB", self.q_NB, "1", "attitude of B in N");
    visit("v_NB_N", self.v_NB_N, "m/s", "velocity of the centre of mass");
    visit("w_NB_B", self.w_NB_B, "rad/s", "angular velocity");
    visit("f_B", self.f_B, "m/s^2",
          "specific force of the centre of mass, mean over the last step, contact included");
    visit("w_dot_NB_B", self.w_dot_NB_B, "rad/s^2", "angular acceleration, mean over the last step");
    visit("wind_N", self.wind_N, "m/s", "velocity of the air at the vehicle");
    visit("air_density", self.air_density, "kg/m^3", "density of the air at the vehicle");
    visit("rotor_speed", self.rotor_speed, "rad/s", "speed of each rotor");
    visit("battery_voltage", self.battery_voltage, "V", "at the terminals, under load");
    visit("battery_current", self.battery_current, "A", "drawn from the battery");
    visit("battery_charge_used", self.battery_charge_used, "A*s", "charge drawn so far");
    visit("in_contact", self.in_contact, "1", "touches the ground or an obstacle");
  }
};

}  // namespace ironbird::simulator
