#include "hil_bridge/virtual_fcu/attitude_controller.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kLeastDerivativeStep = 1e-4F;     // s
constexpr float kGreatestIntegratorStep = 0.01F;  // s
constexpr float kLeastIntegratorThrottle = 0.1F;

}  // namespace

void Pid::set_gains(float p, float i, float d, float tau) {
  p_ = p;
  i_ = i;
  d_ = d;
  tau_ = tau;
}

float Pid::run(float dt, float x, float wanted, bool integrate) {
  float x_dot = 0.0F;
  if (dt > kLeastDerivativeStep) {
    derivative_ =
        (2.0F * tau_ - dt) / (2.0F * tau_ + dt) * derivative_ + 2.0F / (2.0F * tau_ + dt) * (x - last_x_);
    x_dot = derivative_;
  }
  last_x_ = x;
  return run(dt, x, wanted, integrate, x_dot);
}

float Pid::run(float dt, float x, float wanted, bool integrate, float x_dot) {
  const float error = wanted - x;
  float output = p_ * error;
  if (d_ > 0.0F) output -= d_ * x_dot;
  if (i_ > 0.0F && integrate) {
    integral_ += error * dt;
    output += i_ * integral_;
  }
  return output;
}

void AttitudeController::configure(const ParameterStore& parameters) {
  equilibrium_torque_ = {parameters.real(parameter("X_EQ_TORQUE")), parameters.real(parameter("Y_EQ_TORQUE")),
                         parameters.real(parameter("Z_EQ_TORQUE"))};
  use_motor_model_ = parameters.on(parameter("USE_MOTOR_PARAM"));
  greatest_throttle_ = parameters.real(parameter("RC_MAX_THR"));
  throttle_scale_ = greatest_throttle_ * (use_motor_model_ ? maximum_thrust_ : 1.0F);
}

void AttitudeController::rebuild(const ParameterStore& parameters, float density) {
  constexpr std::array<ParameterId, 3> kRateGains = {
      parameter("PID_ROLL_RATE_P"), parameter("PID_PITCH_RATE_P"), parameter("PID_YAW_RATE_P")};
  constexpr std::array<ParameterId, 2> kAngleGains = {parameter("PID_ROLL_ANG_P"),
                                                      parameter("PID_PITCH_ANG_P")};
  const float tau = parameters.real(parameter("PID_TAU"));
  const auto set_gains = [&](Pid& loop, ParameterId p) {
    loop.set_gains(parameters.real(p), parameters.real(p + 1), parameters.real(p + 2), tau);
  };
  for (std::size_t k = 0; k < rate_loops_.size(); ++k) set_gains(rate_loops_[k], kRateGains[k]);
  for (std::size_t k = 0; k < angle_loops_.size(); ++k) set_gains(angle_loops_[k], kAngleGains[k]);
  maximum_thrust_ = virtual_fcu::maximum_thrust(parameters, density);
  configure(parameters);
}

float AttitudeController::torque(int axis, const Channel& channel, const Attitude& attitude, float dt,
                                 bool integrate) {
  const std::array<float, 3> rates = {attitude.w_NB_B.x, attitude.w_NB_B.y, attitude.w_NB_B.z};
  const auto k = static_cast<std::size_t>(axis);
  if (channel.kind == ChannelKind::kRate) return rate_loops_[k].run(dt, rates[k], channel.value, integrate);
  if (channel.kind == ChannelKind::kAngle && k < angle_loops_.size()) {
    const float angle = k == 0 ? attitude.roll() : attitude.pitch();
    return angle_loops_[k].run(dt, angle, channel.value, integrate, rates[k]);
  }
  return channel.value;
}

float AttitudeController::force(int axis, const Channel& channel) const {
  if (channel.kind != ChannelKind::kThrottle) return channel.value;
  const float value = channel.value * throttle_scale_;
  return axis == kForceZ ? -value : value;
}

std::array<float, kMixerInputs> AttitudeController::run(const Command& command, const Attitude& attitude,
                                                        float dt, bool armed) {
  const bool throttle_up = command.u[kForceX].value > kLeastIntegratorThrottle ||
                           command.u[kForceY].value > kLeastIntegratorThrottle ||
                           command.u[kForceZ].value > kLeastIntegratorThrottle;
  const bool integrate = armed && throttle_up && dt < kGreatestIntegratorStep;
  std::array<float, kMixerInputs> u{};
  for (int axis = kForceX; axis <= kForceZ; ++axis) {
    u[static_cast<std::size_t>(axis)] = force(axis, command.u[static_cast<std::size_t>(axis)]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    u[kRoll + k] =
        torque(static_cast<int>(k), command.u[kRoll + k], attitude, dt, integrate) + equilibrium_torque_[k];
  }
  for (std::size_t i = kFirstFree; i < kMixerInputs; ++i) u[i] = command.u[i].value;
  return u;
}

std::array<float, 3> AttitudeController::trim(const Command& command) {
  const Attitude level;
  std::array<float, 3> torques{};
  for (std::size_t k = 0; k < 3; ++k) {
    torques[k] = torque(static_cast<int>(k), command.u[kRoll + k], level, 0.0F, false);
  }
  return torques;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
