#include "autopilot/controller/controller.hpp"

#include "autopilot/math/finite.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {

namespace {
const ControlSetpoint kNothing = NoSetpoint{};
}

const FcuCommand& Controller::run(const ControlSetpoint& setpoint, bool landing,
                                  const StateEstimate& estimate, const FcuStatus& status) {
  double dt = 0.0;
  if (!divider_.due(estimate.stamp, period(), dt)) return last_;
  last_ = control(all_finite(setpoint) ? setpoint : kNothing, landing, estimate, status, dt, phase_);
  if (!all_finite(last_)) {
    last_ = SilenceCommand{};
    ++withheld_commands_;
  }
  return last_;
}

void Controller::reset() {
  last_ = SilenceCommand{};
  phase_ = FlightPhase::kDisarmed;
  divider_.reset();
  withheld_commands_ = 0;
}

void Controller::take_over(const Signals& signals) {
  last_ = signals.command;
  phase_ = signals.flight.phase;
}

}  // namespace ironbird::autopilot
