#include "hil_bridge/virtual_fcu/motor_model.hpp"

#include <cmath>
#include <numbers>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kFourPiSquaredF = 4.0F * std::numbers::pi_v<float> * std::numbers::pi_v<float>;

}  // namespace

MotorModel MotorModel::from(const ParameterStore& parameters) {
  return {.resistance = parameters.real(parameter("MOTOR_RESISTANCE")),
          .back_emf = parameters.real(parameter("MOTOR_KV")),
          .no_load_current = parameters.real(parameter("NO_LOAD_CURRENT")),
          .diameter = parameters.real(parameter("PROP_DIAMETER")),
          .thrust_coefficient = parameters.real(parameter("PROP_CT")),
          .torque_coefficient = parameters.real(parameter("PROP_CQ"))};
}

float MotorModel::load_voltage(float density) const {
  const float d5 = diameter * diameter * diameter * diameter * diameter;
  return resistance * density * d5 * torque_coefficient / (kFourPiSquaredF * back_emf);
}

float MotorModel::speed(float voltage, float density) const {
  const float a = load_voltage(density);
  const float b = back_emf;
  const float c = no_load_current * resistance - voltage;
  return (-b + std::sqrt(b * b - 4.0F * a * c)) / (2.0F * a);
}

float MotorModel::thrust(float speed, float density) const {
  const float d4 = diameter * diameter * diameter * diameter;
  return density * d4 * thrust_coefficient * speed * speed / kFourPiSquaredF;
}

float maximum_thrust(const ParameterStore& parameters, float density) {
  const MotorModel motor = MotorModel::from(parameters);
  const float speed = motor.speed(parameters.real(parameter("BATT_VOLT_MAX")), density);
  return static_cast<float>(parameters.integer(parameter("NUM_MOTORS"))) * motor.thrust(speed, density);
}

}  // namespace ironbird::hil_bridge::virtual_fcu
