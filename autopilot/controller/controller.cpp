#include "autopilot/controller/controller.hpp"

#include <algorithm>

#include "autopilot/math/finite.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

namespace {
const ControlSetpoint kNothing = NoSetpoint{};
}

const FcuCommand& Controller::run(const ControlSetpoint& setpoint, bool landing,
                                  const StateEstimate& estimate, const FcuStatus& status) {
  double dt = 0.0;
  if (!stands_still(estimate) && !divider_.due(estimate.stamp, period(), dt)) return last_;
  // Where the estimate has jumped, not the vehicle has moved, but where it is said to be.
  memory_.point_N += estimate.position_reset_sum_N - position_reset_sum_N_;
  position_reset_sum_N_ = estimate.position_reset_sum_N;
  const FlightPhase before = phase();
  last_ = control(all_finite(setpoint) ? setpoint : kNothing, landing, estimate, status, dt, step_);
  if (phase() != before) {
    memory_.phase_began = estimate.stamp;
    if (before == FlightPhase::kDisarmed || phase() == FlightPhase::kTakeOff) {
      memory_.launched = true;
      memory_.launch_N = estimate.p_NB_N;
      memory_.launch_heading = estimate.heading;
    }
  }
  if (!all_finite(last_)) last_ = SilenceCommand{};
  return last_;
}

bool Controller::stands_still(const StateEstimate& estimate) {
  const bool so = estimate.stamp == stamp_ && !is_usable(estimate.health);
  standing_still_ = so ? std::min(standing_still_ + 1, kMostStandingStill + 1) : 0;
  stamp_ = estimate.stamp;
  return so;
}

void Controller::reset() {
  last_ = SilenceCommand{};
  step_ = PhaseStep{};
  memory_ = FlightMemory{};
  position_reset_sum_N_.setZero();
  divider_.reset();
  stamp_ = Time{-1};
  standing_still_ = 0;
}

void Controller::take_over(const Signals& signals) {
  last_ = signals.command;
  step_ = {signals.flight.phase, signals.flight.cause};
  memory_ = signals.flight.memory;
  position_reset_sum_N_ = signals.estimate.position_reset_sum_N;
}

}  // namespace ironbird::autopilot
