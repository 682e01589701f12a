#pragma once

#include <array>

#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Mounting rotations, biases and formulas between the sensor chips and the rest of the firmware. No filter
/// and no outlier test: the firmware has none.
class SensorCorrections {
 public:
  /// Takes over biases, matrices and mounting angles.
  void configure(const ParameterStore& parameters);

  /// Turns a sample from chip axes into body axes, nothing else: what calibrations average.
  ImuInput rotated(const ImuInput& raw) const;
  /// Subtracts bias and temperature drift from a rotated sample.
  ImuInput corrected(const ImuInput& rotated) const;
  /// Turns, subtracts the hard iron, multiplies by the soft-iron matrix.
  Triple magnetic(const Triple& raw) const;
  /// Pa, bias removed.
  float differential_pressure(float raw) const { return raw - differential_pressure_bias_; }

 private:
  using Matrix = std::array<float, 9>;  // row-major
  static Matrix mounting(const ParameterStore& parameters, ParameterId roll);
  static Triple times(const Matrix& m, const Triple& v);

  Matrix imu_mounting_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Matrix mag_mounting_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Matrix soft_iron_{1, 0, 0, 0, 1, 0, 0, 0, 1};
  bool imu_turned_ = false;
  Triple gyro_bias_;
  Triple acceleration_bias_;
  Triple acceleration_drift_;  // per kelvin
  Triple hard_iron_;
  float differential_pressure_bias_ = 0.0F;
};

/// Height at which the standard atmosphere has this pressure, m. @param pressure  Pa
float pressure_altitude(float pressure);
/// Density that the firmware takes to belong to this pressure, kg/m^3. @param pressure  Pa
float density_of(float pressure);
/// Signed airspeed, m/s. @param differential_pressure  Pa
float indicated_airspeed(float differential_pressure);

/// Are all six accelerometer and gyro biases exactly zero?
bool imu_biases_are_zero(const ParameterStore& parameters);

}  // namespace ironbird::hil_bridge::virtual_fcu
