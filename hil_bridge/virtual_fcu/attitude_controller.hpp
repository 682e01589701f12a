#pragma once

#include <array>

#include "hil_bridge/virtual_fcu/attitude_filter.hpp"
#include "hil_bridge/virtual_fcu/command.hpp"
#include "hil_bridge/virtual_fcu/motor_model.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// One loop of the firmware. Unlimited: neither its output nor its integral has a bound.
class Pid {
 public:
  /// Sets gains; integral and derivative keep their values.
  void set_gains(float p, float i, float d, float tau);

  /// Output for the measurement `x` with its own band-limited derivative.
  float run(float dt, float x, float wanted, bool integrate);
  /// Output with the derivative of the measurement given.
  float run(float dt, float x, float wanted, bool integrate, float x_dot);

 private:
  float p_ = 0.0F;
  float i_ = 0.0F;
  float d_ = 0.0F;
  float tau_ = 0.05F;
  float integral_ = 0.0F;
  float derivative_ = 0.0F;
  float last_x_ = 0.0F;
};

/// Turns the combined command and the attitude into the mixer's ten inputs. Runs once per IMU sample.
class AttitudeController {
 public:
  /// Takes over the parameters that act at once.
  void configure(const ParameterStore& parameters);
  /// Takes over gains and recomputes the maximum thrust.
  /// @param density  of the air now, kg/m^3
  void rebuild(const ParameterStore& parameters, float density);

  /// @param dt     since the last IMU sample, s
  /// @param armed  integrators run only when armed, with throttle above 0.1 and dt below 10 ms
  std::array<float, kMixerInputs> run(const Command& command, const Attitude& attitude, float dt, bool armed);

  /// Torques that the command would cause with a level, still vehicle: what the trim calibration adds to the
  /// equilibrium torques.
  std::array<float, 3> trim(const Command& command);

  float maximum_thrust() const { return maximum_thrust_; }

 private:
  float torque(int axis, const Channel& channel, const Attitude& attitude, float dt, bool integrate);
  float force(int axis, const Channel& channel) const;

  std::array<Pid, 3> rate_loops_;
  std::array<Pid, 2> angle_loops_;
  std::array<float, 3> equilibrium_torque_{};
  float maximum_thrust_ = 0.0F;
  float throttle_scale_ = 0.0F;
  bool use_motor_model_ = false;
  float greatest_throttle_ = 0.7F;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
