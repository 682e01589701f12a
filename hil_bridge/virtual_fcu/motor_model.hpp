#pragma once

#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// The firmware's picture of motor and propeller: steady state, torque constant equal to back-EMF constant.
struct MotorModel {
  float resistance = 0.0F;
  float back_emf = 0.0F;
  float no_load_current = 0.0F;
  float diameter = 0.0F;
  float thrust_coefficient = 0.0F;
  float torque_coefficient = 0.0F;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("resistance", self.resistance, "ohm", "winding resistance");
    visit("back_emf", self.back_emf, "V*s/rad", "back-EMF constant");
    visit("no_load_current", self.no_load_current, "A", "current of a free motor");
    visit("diameter", self.diameter, "m", "propeller diameter");
    visit("thrust_coefficient", self.thrust_coefficient, "1", "CT");
    visit("torque_coefficient", self.torque_coefficient, "1", "CQ");
  }

  static MotorModel from(const ParameterStore& parameters);

  /// Voltage per squared speed that the propeller's torque costs, V/(rad/s)^2. @param density  kg/m^3
  float load_voltage(float density) const;

  /// Speed at which the motor settles, rad/s. @param voltage  V @param density  kg/m^3
  float speed(float voltage, float density) const;

  /// Thrust of one propeller, N. @param speed  rad/s @param density  kg/m^3
  float thrust(float speed, float density) const;
};

/// Thrust of NUM_MOTORS motors at BATT_VOLT_MAX, N.
float maximum_thrust(const ParameterStore& parameters, float density);

}  // namespace ironbird::hil_bridge::virtual_fcu
