#pragma once

#include <array>
#include <span>

#include "simulator/fault/fault.hpp"
#include "simulator/types/rotor_commands.hpp"

namespace ironbird::simulator {

/// What keeps a sensor from delivering good samples.
struct Outage {
  bool dropout = false;
  bool non_finite = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("dropout", self.dropout, "1", "no samples");
    visit("non_finite", self.non_finite, "1", "samples are NaN");
  }
};

/// The sum of the faults that act at one instant. Faults of one kind add up: efficiencies multiply, biases,
/// winds and payloads add, outages are or-ed. `FaultKind::kBatteryCharge` is an event, not a state, and has
/// no member here.
struct FaultState {
  std::array<double, kMaxRotors> rotor_efficiency{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  Outage imu;
  Outage mag;
  Outage baro;
  Outage gnss;
  Vector3 accelerometer_bias = Vector3::Zero();
  Vector3 gyro_bias = Vector3::Zero();
  Vector3 mag_bias = Vector3::Zero();
  double baro_bias = 0.0;
  Vector3 gnss_jump_N = Vector3::Zero();
  Vector3 wind_N = Vector3::Zero();
  double payload = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("rotor_efficiency", self.rotor_efficiency, "1", "share of thrust and torque left, 0 lost");
    visit("imu", self.imu, "", "outage of the inertial measurement unit");
    visit("mag", self.mag, "", "outage of the magnetometer");
    visit("baro", self.baro, "", "outage of the barometer");
    visit("gnss", self.gnss, "", "outage of the satellite receiver");
    visit("accelerometer_bias", self.accelerometer_bias, "m/s^2", "added to the accelerometer");
    visit("gyro_bias", self.gyro_bias, "rad/s", "added to the gyro");
    visit("mag_bias", self.mag_bias, "T", "added to the magnetometer");
    visit("baro_bias", self.baro_bias, "Pa", "added to the barometer");
    visit("gnss_jump_N", self.gnss_jump_N, "m", "added to the position of the satellite receiver");
    visit("wind_N", self.wind_N, "m/s", "added to the wind");
    visit("payload", self.payload, "kg", "added at the centre of mass");
  }
};

/// @throws std::invalid_argument when a vehicle of `rotor_count` rotors cannot have this fault: naming the
/// kind, the value and the bound
void check(const Fault& fault, int rotor_count);

/// Adds one fault to a state. @param fault  `index` of a rotor fault in 0..kMaxRotors-1
void add(const Fault& fault, FaultState& state);

/// The sum of `faults`.
FaultState combine(std::span<const Fault> faults);

}  // namespace ironbird::simulator
