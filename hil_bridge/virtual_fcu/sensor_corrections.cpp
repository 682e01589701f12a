#include "hil_bridge/virtual_fcu/sensor_corrections.hpp"

#include <cmath>
#include <numbers>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kRadians = std::numbers::pi_v<float> / 180.0F;

Triple triple(const ParameterStore& parameters, ParameterId first) {
  return {parameters.real(first), parameters.real(first + 1), parameters.real(first + 2)};
}

}  // namespace

SensorCorrections::Matrix SensorCorrections::mounting(const ParameterStore& parameters, ParameterId first) {
  const Triple angles = triple(parameters, first);
  const float cr = std::cos(angles.x * kRadians);
  const float sr = std::sin(angles.x * kRadians);
  const float cp = std::cos(angles.y * kRadians);
  const float sp = std::sin(angles.y * kRadians);
  const float cy = std::cos(angles.z * kRadians);
  const float sy = std::sin(angles.z * kRadians);
  // Transpose of R(z) R(y) R(x): the passive rotation.
  return {cp * cy,
          cp * sy,
          -sp,  //
          sr * sp * cy - cr * sy,
          sr * sp * sy + cr * cy,
          sr * cp,  //
          cr * sp * cy + sr * sy,
          cr * sp * sy - sr * cy,
          cr * cp};
}

Triple SensorCorrections::times(const Matrix& m, const Triple& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

void SensorCorrections::configure(const ParameterStore& parameters) {
  const Triple angles = triple(parameters, parameter("IMU_ROLL"));
  imu_turned_ = angles.x != 0.0F || angles.y != 0.0F || angles.z != 0.0F;
  imu_mounting_ = mounting(parameters, parameter("IMU_ROLL"));
  mag_mounting_ = mounting(parameters, parameter("MAG_ROLL"));
  for (int k = 0; k < 9; ++k) soft_iron_[k] = parameters.real(parameter("MAG_CAL_A00") + k);
  gyro_bias_ = triple(parameters, parameter("GYRO_X_BIAS"));
  acceleration_bias_ = triple(parameters, parameter("ACC_X_BIAS"));
  acceleration_drift_ = triple(parameters, parameter("ACC_X_TEMP_COMP"));
  hard_iron_ = triple(parameters, parameter("MAG_X_BIAS"));
  differential_pressure_bias_ = parameters.real(parameter("DIFF_PRESS_BIAS"));
}

ImuInput SensorCorrections::rotated(const ImuInput& raw) const {
  if (!imu_turned_) return raw;
  ImuInput result = raw;
  result.acceleration = times(imu_mounting_, raw.acceleration);
  result.angular_velocity = times(imu_mounting_, raw.angular_velocity);
  return result;
}

ImuInput SensorCorrections::corrected(const ImuInput& rotated) const {
  ImuInput result = rotated;
  const float kelvin = rotated.temperature;
  result.acceleration.x -= acceleration_drift_.x * kelvin + acceleration_bias_.x;
  result.acceleration.y -= acceleration_drift_.y * kelvin + acceleration_bias_.y;
  result.acceleration.z -= acceleration_drift_.z * kelvin + acceleration_bias_.z;
  result.angular_velocity.x -= gyro_bias_.x;
  result.angular_velocity.y -= gyro_bias_.y;
  result.angular_velocity.z -= gyro_bias_.z;
  return result;
}

Triple SensorCorrections::magnetic(const Triple& raw) const {
  Triple field = times(mag_mounting_, raw);
  field.x -= hard_iron_.x;
  field.y -= hard_iron_.y;
  field.z -= hard_iron_.z;
  return times(soft_iron_, field);
}

float pressure_altitude(float pressure) {
  return 44318.14F * (1.0F - std::pow(pressure / 101325.0F, 0.190327F));
}

float density_of(float pressure) {
  return kSeaLevelDensity * std::pow(pressure / 101325.0F, 0.8097368946F);
}

float indicated_airspeed(float differential_pressure) {
  const float speed = std::sqrt(2.0F * std::fabs(differential_pressure) / kSeaLevelDensity);
  return differential_pressure < 0.0F ? -speed : speed;
}

bool imu_biases_are_zero(const ParameterStore& parameters) {
  const Triple gyro = triple(parameters, parameter("GYRO_X_BIAS"));
  const Triple acceleration = triple(parameters, parameter("ACC_X_BIAS"));
  return gyro.x == 0.0F && gyro.y == 0.0F && gyro.z == 0.0F && acceleration.x == 0.0F &&
         acceleration.y == 0.0F && acceleration.z == 0.0F;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
