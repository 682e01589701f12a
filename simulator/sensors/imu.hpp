#pragma once

#include <cstdint>

#include "simulator/fault/fault_state.hpp"
#include "simulator/sensors/error_model.hpp"
#include "simulator/sensors/mounting.hpp"
#include "simulator/sensors/sensor_site.hpp"
#include "simulator/sensors/timing.hpp"
#include "simulator/types/readings.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::simulator {

/// Accelerometer and gyro in one chip.
struct ImuParams {
  TimingParams timing{.rate = 400.0};
  MountingParams mounting;
  VectorErrorParams<AccelerationUnits> accelerometer;
  VectorErrorParams<AngularRateUnits> gyro;
  double accelerometer_vibration = 0.0;
  double gyro_vibration = 0.0;
  double temperature = 300.15;
  bool noise_only_when_armed = false;
  double rest_speed = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("timing", self.timing, "", "when it samples");
    visit("mounting", self.mounting, "", "where it sits");
    visit("accelerometer", self.accelerometer, "", "errors of the accelerometer");
    visit("gyro", self.gyro, "", "errors of the gyro");
    visit("accelerometer_vibration", self.accelerometer_vibration, "m/s^2/(rad/s)^2",
          "white noise of one rotor per its speed squared", 0.0, 1.0);
    visit("gyro_vibration", self.gyro_vibration, "rad/s/(rad/s)^2",
          "white noise of one rotor per its speed squared", 0.0, 1.0);
    visit("temperature", self.temperature, "K", "of the chip", 200.0, 400.0);
    visit("noise_only_when_armed", self.noise_only_when_armed, "1",
          "no white noise while disarmed, as the reference simulator");
    visit("rest_speed", self.rest_speed, "m/s",
          "slower than this the accelerometer reads exactly gravity, as the reference simulator; 0: never",
          0.0, 10.0);
  }
};

/// Specific force and angular velocity at the sensor, in its own axes.
///
/// f_S = f_cm + w_dot x r + w x (w x r) with r from the centre of mass to the sensor. Rotor vibration is
/// white: the amplitudes of unbalanced rotors grow with the square of speed and add in quadrature. It does
/// not model the filters of the chip.
class Imu {
 public:
  using Reading = ImuReading;

  Imu(const ImuParams& params, const SensorSite& site, double period, std::uint64_t seed);

  /// The reading at `now`. @param armed  the FCU lets the motors turn
  ImuReading measure(const Truth& truth, Time now, const FaultState& faults, bool armed);

 private:
  Vector3 specific_force_B(const Truth& truth) const;

  ImuParams params_;
  Matrix3 R_SB_;
  double gravity_;
  VectorError accelerometer_;
  VectorError gyro_;
};

}  // namespace ironbird::simulator
