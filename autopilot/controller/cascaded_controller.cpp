#include "autopilot/controller/cascaded_controller.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/controller/phase_table.hpp"
#include "autopilot/handover.hpp"

namespace ironbird::autopilot {

namespace {

// So near to the height of the launch the vehicle is more likely on the ground than in the air.
constexpr double kLow = 1.0;         // m
constexpr double kOffGround = 0.3;   // m from the launch: the climb has begun
constexpr double kBlindTilt = 0.35;  // rad, 1 sigma: less sure it is better not to turn
constexpr double kBlindLift = 0.97;  // of what carried it: rather down than up
// Near the ground it is to come down before long, but with less speed than from a fall: 1.7 m/s from 1 m.
constexpr double kLowBlindLift = 0.85;
constexpr double kLiftLag = 3.0;       // s: longer than a climb or a brake begins and ends
constexpr double kMostMistaken = 1.5;  // times the weight, or its inverse, that the mass may be wrong by
// A vehicle that sinks slower than this share of what it was told to is held up by something.
constexpr double kStoppedShare = 0.4;

bool is_usable(const StateEstimate& estimate) {
  return is_usable(estimate.health) && estimate.p_NB_N.allFinite() && estimate.v_NB_B.allFinite() &&
         estimate.w_NB_B.allFinite() && estimate.q_NB.coeffs().allFinite() &&
         std::isfinite(estimate.roll + estimate.pitch + estimate.heading);
}

}  // namespace

void CascadedController::reset() {
  Controller::reset();
  cascade_.reset();
  touch_down_.reset();
  armed_at_.reset();
  seen_disarmed_ = false;
  rest_.reset();
  upright_.reset();
  descent_.reset();
}

void CascadedController::hand_over(Handover& handover) const {
  Controller::hand_over(handover);
  handover.armed_at = armed_at_;
}

void CascadedController::take_over(const Handover& left) {
  Controller::take_over(left);
  armed_at_ = left.armed_at;
  touch_down_.restore(memory().on_ground);
  upright_.restore(memory().given_up);
  rest_.restore(memory().may_lie);
  // What was asked for just now begins something new: going on as before would be to work against it.
  if (!left.flight.fcu.overridden() && !left.wish && !left.new_setpoint)
    cascade_.resume(left.command, left.estimate);
  if (memory().has_point) return;
  notebook().has_point = true;
  notebook().point_N = left.estimate.p_NB_N;
  notebook().point_heading = left.estimate.heading;
}

std::string_view CascadedController::refusal(FlightWish wish, const StateEstimate& estimate,
                                             const FcuStatus& status) const {
  return why_not(wish, {.phase = phase(),
                        .armed = status.armed,
                        .failsafe = status.failsafe,
                        .pilot_holds = status.pilot_holds(),
                        .estimate_usable = is_usable(estimate),
                        .position_known = estimate.position_known,
                        .position_doubtful = estimate.position_doubtful,
                        .on_ground = touch_down_.felt(),
                        .overturned = upright_.overturned()});
}

void CascadedController::probe(ProbeVisitor& visit) const {
  visit("lift", cascade_.lift(), "1");
  visit("on_ground", touch_down_.felt() ? 1.0 : 0.0, "1");
  visit("point_N", memory().point_N, "m");
}

FcuCommand CascadedController::control(const ControlSetpoint& setpoint, bool landing,
                                       const StateEstimate& estimate, const FcuStatus& status, double dt,
                                       PhaseStep& step) {
  watch(estimate, status);
  const FlightPhase before = step.phase;
  const PhaseStep next = next_phase(before, inputs(setpoint, landing, estimate, status, before));
  if (next.phase != before) {
    step = next;
    enter(next.phase, before, estimate);
  }
  if (step.phase == FlightPhase::kDisarmed) {
    // In silence the FCU would try to right what lies on its propellers.
    if (status.armed && upright_.stops(estimate.stamp)) return stop();
    cascade_.reset();
    if (status.armed || !params().zeros_while_disarmed) return SilenceCommand{};
    return PassThroughCommand{};
  }
  if (upright_.stops(estimate.stamp)) return stop();
  if (step.phase == FlightPhase::kSilent) {
    return without_estimate(estimate, status.overridden() || rest_.may_lie(), dt);
  }
  const FcuCommand command = fly(setpoint, estimate, status, dt, step.phase);
  note_lift(command, estimate, status, dt);
  return command;
}

void CascadedController::note_lift(const FcuCommand& command, const StateEstimate& estimate,
                                   const FcuStatus& status, double dt) {
  const auto* direct = std::get_if<PassThroughCommand>(&command);
  const double height = memory().launch_N.z() - estimate.p_NB_N.z();
  if (direct == nullptr || direct->thrust <= 0.0 || status.overridden() || std::abs(height) < kOffGround)
    return;
  const double lift = direct->thrust * estimate.upright() / (params().mass * params().gravity);
  double& known = notebook().lift;
  known = std::clamp(known + (lift - known) * dt / (kLiftLag + dt), 1.0 / kMostMistaken, kMostMistaken);
}

FcuCommand CascadedController::stop() {
  cascade_.reset();
  descent_.reset();
  return PassThroughCommand{};
}

FcuCommand CascadedController::fly(const ControlSetpoint& setpoint, const StateEstimate& estimate,
                                   const FcuStatus& status, double dt, FlightPhase phase) {
  const bool overridden = status.overridden() || rest_.may_lie();
  const bool stands =
      phase == FlightPhase::kTakeOff && std::abs(memory().launch_N.z() - estimate.p_NB_N.z()) < kOffGround;
  if (overridden && !stands && is_usable(estimate)) {
    notebook().point_N = cascade_.resting_place(estimate, params().braking_acceleration);
    notebook().point_heading = estimate.heading;
  }
  if (rest_.may_lie()) return stop();
  Cascade::Step how{dt, !overridden, params().take_off_pass_through};
  switch (phase) {
    case FlightPhase::kTakeOff:
      return cascade_.fly(climb(), estimate, how);
    case FlightPhase::kHold:
      return cascade_.come_to(hold(), estimate, how);
    case FlightPhase::kLanding:
    case FlightPhase::kLevelDescent:
      return land(phase, estimate, overridden, how);
    default:
      how.thrust_in_newtons = params().acceleration_output == 1;
      return cascade_.fly(setpoint, estimate, how);
  }
}

void CascadedController::watch(const StateEstimate& estimate, const FcuStatus& status) {
  // Only who was seen disarmed can be seen arming: a controller that comes late must not take off for it.
  if (status.armed && seen_disarmed_) armed_at_ = estimate.stamp;
  if (!status.armed) armed_at_.reset();
  seen_disarmed_ = !status.armed && status.stamp.count() > 0;
  // On the ground the companion is silent, so that "not heard" alone tells nothing there.
  const bool left_alone = phase() == FlightPhase::kSilent && status.overridden();
  const bool taken = status.failsafe || status.pilot_holds();
  rest_.look(estimate, is_usable(estimate), status, taken || left_alone || status.throttle_limited(),
             params());
  if (!status.armed) upright_.forgive();
  const bool flies = phase() != FlightPhase::kDisarmed;
  upright_.look(estimate, is_usable(estimate), rest_.still(), flies ? cascade_.asked_upright() : std::nullopt,
                taken);
  if (!estimate.position_doubtful) notebook().last_sure = estimate.stamp;
  notebook().given_up = upright_.given_up();
  notebook().may_lie = rest_.may_lie();
}

bool CascadedController::rests_with_pilot(const StateEstimate& estimate) const {
  const bool low = memory().launched && std::abs(memory().launch_N.z() - estimate.p_NB_N.z()) < kLow;
  return rest_.rests(estimate.stamp, low || upright_.lies(estimate.stamp), params());
}

bool CascadedController::take_off_wanted(const ControlSetpoint& setpoint, const StateEstimate& estimate,
                                         const FcuStatus& status, FlightPhase phase) const {
  // Whoever takes the vehicle between the grant and the step keeps it.
  if (status.failsafe || status.pilot_holds() || upright_.overturned()) return false;
  if (wished(FlightWish::kTakeOff)) return true;
  return params().take_off_on_arming && phase == FlightPhase::kDisarmed && armed_at_ &&
         seconds(estimate.stamp - *armed_at_) <= params().arming_patience &&
         !std::holds_alternative<NoSetpoint>(setpoint);
}

PhaseInputs CascadedController::inputs(const ControlSetpoint& setpoint, bool landing,
                                       const StateEstimate& estimate, const FcuStatus& status,
                                       FlightPhase phase) const {
  const double in_phase = seconds(estimate.stamp - memory().phase_began);
  const double target_down = memory().launch_N.z() - params().take_off_height;
  PhaseInputs in;
  in.armed = status.armed;
  in.estimate_usable = is_usable(estimate);
  in.position_known = estimate.position_known;
  in.position_doubtful = estimate.position_doubtful;
  const double in_doubt = std::min(in_phase, seconds(estimate.stamp - memory().last_sure));
  in.doubt_long = in_doubt >= params().doubt_patience;
  in.setpoint_valid = !std::holds_alternative<NoSetpoint>(setpoint);
  in.take_off_wanted = take_off_wanted(setpoint, estimate, status, phase);
  in.height_reached =
      in.estimate_usable && estimate.p_NB_N.z() <= target_down + params().take_off_height_threshold;
  in.hold_over = in_phase >= params().take_off_hold_time;
  in.route_lands = landing;
  in.landing_wanted = wished(FlightWish::kLand);
  in.resume_wanted = wished(FlightWish::kResume);
  in.on_ground = touch_down_.felt();
  in.rests_with_pilot = rests_with_pilot(estimate);
  in.silence_short = in_phase <= params().silence_patience;
  return in;
}

void CascadedController::enter(FlightPhase phase, FlightPhase from, const StateEstimate& estimate) {
  touch_down_.reset();
  descent_.reset();
  if (phase == FlightPhase::kDisarmed || phase == FlightPhase::kTakeOff) {
    rest_.reset();
  }
  FlightMemory& m = notebook();
  const bool off_ground = std::abs(m.launch_N.z() - estimate.p_NB_N.z()) > kOffGround;
  m.blind = phase == FlightPhase::kSilent && m.launched && !m.on_ground && off_ground;
  m.on_ground = false;
  m.phase_began = estimate.stamp;                                      // already in this step
  if (from == FlightPhase::kTakeOff && phase == FlightPhase::kHold) {  // over the place where it climbed
    m.point_N.z() = std::min(estimate.p_NB_N.z(), m.launch_N.z() - params().take_off_height);
    return;
  }
  if (!is_usable(estimate)) return;
  m.has_point = true;
  m.point_N = phase == FlightPhase::kTakeOff
                  ? estimate.p_NB_N
                  : cascade_.resting_place(estimate, params().braking_acceleration);
  m.point_heading = estimate.heading;
}

FcuCommand CascadedController::without_estimate(const StateEstimate& estimate, bool overridden, double dt) {
  // In the air silence is a fall when the pilot's throttle is down. The FCU's angle mode is no way out: that
  // stick limits the throttle there too.
  const double in_phase = seconds(estimate.stamp - memory().phase_began);
  const bool blind = memory().blind && !overridden && !time_lost() && in_phase <= params().silence_patience;
  const bool low = std::abs(memory().launch_N.z() - estimate.p_NB_N.z()) < kLow;
  const double thrust = (low ? kLowBlindLift : kBlindLift) * memory().lift * params().mass * params().gravity;
  const bool knows_up = std::isfinite(estimate.roll + estimate.pitch) && estimate.w_NB_B.allFinite() &&
                        estimate.sigma_attitude.head<2>().maxCoeff() < kBlindTilt;
  if (blind && knows_up) {
    return cascade_.fly(AngleHeadingRateThrust{0.0, 0.0, 0.0, thrust}, estimate, Cascade::Step{dt});
  }
  cascade_.reset();
  if (!blind) return SilenceCommand{};
  return PassThroughCommand{Vector3::Zero(), thrust};  // nothing is known to turn against
}

ControlSetpoint CascadedController::climb() const {
  return PositionClimbHeading{memory().point_N.head<2>(), -params().take_off_speed, memory().point_heading};
}

Approach CascadedController::hold() const {
  return {memory().point_N, {}, memory().point_heading, params().braking_acceleration};
}

double CascadedController::sink_rate(const StateEstimate& estimate) const {
  const bool high = memory().launch_N.z() - estimate.p_NB_N.z() > params().landing_slow_height;
  return high ? params().descent_speed : params().landing_speed;
}

FcuCommand CascadedController::land(FlightPhase phase, const StateEstimate& estimate, bool overridden,
                                    const Cascade::Step& step) {
  // Others may have flown it off; while it lies still it is where it landed.
  if (overridden && !rest_.still_with_others()) touch_down_.reset();
  notebook().on_ground = touch_down_.felt();
  if (touch_down_.felt() || !is_usable(estimate)) return stop();
  if (overridden) descent_.reset();
  const double v_down = descent_.sink(estimate, sink_rate(estimate), step.dt, params().braking_acceleration,
                                      params().max_climb_acceleration);
  const Approach over_the_point{memory().point_N, v_down, memory().point_heading,
                                params().braking_acceleration};
  const FcuCommand command = phase == FlightPhase::kLevelDescent
                                 ? cascade_.sink_level(v_down, estimate, step)
                                 : cascade_.come_to(over_the_point, estimate, step);
  if (!overridden) {
    const double stopped = std::min(params().touch_down_speed, kStoppedShare * v_down);
    touch_down_.feel(estimate.stamp, cascade_.lift(), estimate.v_NB_N().z(), stopped,
                     params().touch_down_lift, params().touch_down_time);
  }
  return command;
}

}  // namespace ironbird::autopilot
