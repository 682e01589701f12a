#include "autopilot/controller/controller.hpp"

#include <algorithm>

#include "autopilot/handover.hpp"
#include "autopilot/math/finite.hpp"

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
  wish_.reset();
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

RequestOutcome Controller::request(FlightWish wish, const StateEstimate& estimate, const FcuStatus& status) {
  const std::string_view why = refusal(wish, estimate, status);
  if (!why.empty()) return {false, std::string(why)};
  wish_ = wish;
  return {true, ""};
}

void Controller::reset() {
  last_ = SilenceCommand{};
  step_ = PhaseStep{};
  memory_ = FlightMemory{};
  wish_.reset();
  position_reset_sum_N_.setZero();
  divider_.reset();
  stamp_ = Time{-1};
  standing_still_ = 0;
}

void Controller::hand_over(Handover& handover) const {
  handover.wish = wish_;
}

void Controller::take_over(const Handover& left) {
  last_ = left.command;
  step_ = {left.flight.phase, left.flight.cause};
  memory_ = left.flight.memory;
  wish_ = left.wish;
  position_reset_sum_N_ = left.estimate.position_reset_sum_N;
}

}  // namespace ironbird::autopilot
