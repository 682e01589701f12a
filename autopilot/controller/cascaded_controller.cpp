#include "autopilot/controller/cascaded_controller.hpp"

#include <algorithm>

namespace ironbird::autopilot {

namespace {

bool is_usable(const StateEstimate& estimate) {
  const bool trusted = estimate.health == Health::kGood || estimate.health == Health::kDegraded;
  return trusted && estimate.p_NB_N.allFinite() && estimate.v_NB_B.allFinite() &&
         estimate.w_NB_B.allFinite() && estimate.q_NB.coeffs().allFinite() &&
         std::isfinite(estimate.roll + estimate.pitch + estimate.heading);
}

}  // namespace

void CascadedController::reset() {
  Controller::reset();
  cascade_.reset();
  touch_down_.reset();
  take_off_requested_ = landing_requested_ = entered_ = false;
  point_N_.setZero();
  point_heading_ = ground_down_ = 0.0;
}

void CascadedController::probe(ProbeVisitor& visit) const {
  visit("lift", cascade_.lift(), "1");
  visit("on_ground", touch_down_.felt() ? 1.0 : 0.0, "1");
  visit("point_N", point_N_, "m");
}

FcuCommand CascadedController::control(const ControlSetpoint& setpoint, bool landing,
                                       const StateEstimate& estimate, const FcuStatus& status, double dt,
                                       FlightPhase& phase) {
  const bool usable = is_usable(estimate);
  const FlightPhase next = next_phase(phase, inputs(setpoint, landing, estimate, status, phase));
  if (next != phase || !entered_) enter(next, phase, estimate);
  phase = next;
  if (phase == FlightPhase::kDisarmed) {
    cascade_.reset();
    if (status.armed || !params().zeros_while_disarmed) return SilenceCommand{};
    return PassThroughCommand{};
  }
  if (!usable) {
    cascade_.reset();
    return SilenceCommand{};
  }
  const bool overridden = status.failsafe || status.rc_override != 0;
  if (overridden && phase != FlightPhase::kTakeOff) {
    point_N_ = estimate.p_NB_N;
    point_heading_ = estimate.heading;
  }
  Cascade::Step step{dt, !overridden, params().take_off_pass_through};
  switch (phase) {
    case FlightPhase::kTakeOff:
      return cascade_.fly(climb(), estimate, step);
    case FlightPhase::kHold:
      return cascade_.fly(hold(), estimate, step);
    case FlightPhase::kLanding:
      return land(estimate, overridden, step);
    default:
      step.thrust_in_newtons = params().acceleration_output == 1;
      return cascade_.fly(setpoint, estimate, step);
  }
}

PhaseInputs CascadedController::inputs(const ControlSetpoint& setpoint, bool landing,
                                       const StateEstimate& estimate, const FcuStatus& status,
                                       FlightPhase phase) const {
  PhaseInputs in;
  in.armed = status.armed;
  in.estimate_usable = is_usable(estimate);
  in.setpoint_valid = !std::holds_alternative<NoSetpoint>(setpoint);
  in.take_off_wanted = take_off_requested_ ||
                       (params().take_off_on_arming && in.setpoint_valid && phase == FlightPhase::kDisarmed);
  const double target_down = ground_down_ - params().take_off_height;
  in.height_reached =
      in.estimate_usable && estimate.p_NB_N.z() <= target_down + params().take_off_height_threshold;
  in.hold_over = seconds(estimate.stamp - phase_began_) >= params().take_off_hold_time;
  in.route_lands = landing;
  in.landing_wanted = landing_requested_;
  in.on_ground = touch_down_.felt();
  return in;
}

void CascadedController::enter(FlightPhase phase, FlightPhase from, const StateEstimate& estimate) {
  phase_began_ = estimate.stamp;
  entered_ = true;
  touch_down_.reset();
  const bool climbed = from == FlightPhase::kTakeOff && phase == FlightPhase::kHold;
  if (climbed) {
    point_N_.z() = std::min(estimate.p_NB_N.z(), ground_down_ - params().take_off_height);
    return;
  }
  point_N_ = estimate.p_NB_N;
  point_heading_ = estimate.heading;
  if (phase == FlightPhase::kTakeOff) {
    ground_down_ = estimate.p_NB_N.z();
    take_off_requested_ = landing_requested_ = false;
  }
  if (phase == FlightPhase::kLanding) take_off_requested_ = landing_requested_ = false;
  if (phase == FlightPhase::kDisarmed && from != FlightPhase::kDisarmed)
    take_off_requested_ = landing_requested_ = false;
}

ControlSetpoint CascadedController::climb() const {
  return PositionClimbHeading{point_N_.head<2>(), -params().take_off_speed, point_heading_};
}

ControlSetpoint CascadedController::hold() const {
  return PositionHeading{point_N_, point_heading_};
}

ControlSetpoint CascadedController::descend(const StateEstimate& estimate) const {
  const bool high = ground_down_ - estimate.p_NB_N.z() > params().landing_slow_height;
  return PositionClimbHeading{point_N_.head<2>(), high ? params().descent_speed : params().landing_speed,
                              point_heading_};
}

FcuCommand CascadedController::land(const StateEstimate& estimate, bool overridden,
                                    const Cascade::Step& step) {
  if (overridden) touch_down_.reset();
  if (touch_down_.felt()) {
    cascade_.reset();
    return PassThroughCommand{};
  }
  const FcuCommand command = cascade_.fly(descend(estimate), estimate, step);
  if (!overridden) {
    touch_down_.feel(estimate.stamp, cascade_.lift(), estimate.v_NB_N().z(), params().touch_down_speed,
                     params().touch_down_lift, params().touch_down_time);
  }
  return command;
}

}  // namespace ironbird::autopilot
