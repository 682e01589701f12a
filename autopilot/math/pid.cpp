#include "autopilot/math/pid.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::autopilot {

void Pid::configure(const PidGains& gains, double time_constant, double lower, double upper) {
  if (gains.ki != gains_.ki) reset_integral();
  gains_ = gains;
  time_constant_ = time_constant;
  lower_ = lower;
  upper_ = upper;
}

double Pid::run(double error, double rate, double dt, bool integrate) {
  if (!std::isfinite(error + rate + dt)) return 0.0;
  const double direct = gains_.kp * error - gains_.kd * rate;
  const bool room = direct > lower_ && direct < upper_;
  if (integrate && room && gains_.ki > 0.0 && dt > 0.0 && dt <= kStale) {
    integral_ += 0.5 * dt * (error + (has_error_ ? previous_error_ : error));
  }
  previous_error_ = error;
  has_error_ = true;
  const double wanted = direct + gains_.ki * integral_;
  const double given = std::clamp(wanted, lower_, upper_);
  if (room && given != wanted) integral_ = (given - direct) / gains_.ki;
  return given;
}

double Pid::run_filtered(double error, double measurement, double dt, bool integrate) {
  if (!std::isfinite(error + measurement + dt)) return 0.0;
  if (!has_measurement_ || dt > kStale) {
    derivative_ = 0.0;
  } else if (dt > 0.0) {
    // Bilinear transform of s / (time_constant s + 1).
    const double two_tau = 2.0 * time_constant_;
    derivative_ =
        ((two_tau - dt) * derivative_ + 2.0 * (measurement - previous_measurement_)) / (two_tau + dt);
  }
  previous_measurement_ = measurement;
  has_measurement_ = true;
  return run(error, derivative_, dt, integrate);
}

void Pid::aim(double error, double rate, double output) {
  if (!std::isfinite(error + rate + output) || gains_.ki <= 0.0) return;
  const double direct = gains_.kp * error - gains_.kd * rate;
  const bool room = direct > lower_ && direct < upper_;
  integral_ = room ? (std::clamp(output, lower_, upper_) - direct) / gains_.ki : 0.0;
  has_error_ = false;
}

void Pid::reset_integral() {
  integral_ = 0.0;
  has_error_ = false;
}

void Pid::reset() {
  reset_integral();
  derivative_ = 0.0;
  has_measurement_ = false;
}

}  // namespace ironbird::autopilot
