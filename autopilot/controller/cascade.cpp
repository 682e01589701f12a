#include "autopilot/controller/cascade.hpp"

#include <algorithm>
#include <cmath>

#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kSmallestTiltCosine = 0.5;  // of the tilt, where thrust makes up for it: 60 degrees
constexpr double kSmallestLift = 0.1;  // share of gravity, so that an acceleration always has an attitude

double limited(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

/// The horizontal part keeps its direction; z is down.
Vector3 limited(const Vector3& value, double horizontal, double up, double down) {
  const double size = std::sqrt(value.x() * value.x() + value.y() * value.y());
  const double share = size > horizontal ? horizontal / size : 1.0;
  return {share * value.x(), share * value.y(), std::clamp(value.z(), -up, down)};
}

// A vehicle whose wanted speed is `stiffness` times the distance slows down with `stiffness` times its speed.
// Farther off than where that is the deceleration allowed, the wanted speed is that of constant deceleration,
// v^2 = 2 a (d - a/(2 k^2)), which meets the line d k with its slope.

/// @param distance  m
double approach_speed(double distance, double stiffness, double deceleration) {
  const double linear = stiffness * distance;
  const double bend = deceleration / stiffness;
  return linear <= bend ? linear : bend * std::sqrt(2.0 * linear / bend - 1.0);
}

/// The distance with that speed.
double approach_distance(double speed, double stiffness, double deceleration) {
  const double bend = deceleration / stiffness;
  if (speed <= bend) return speed / stiffness;
  return 0.5 * (speed * speed / deceleration + bend / stiffness);
}

}  // namespace

void Cascade::set_params(const CascadeParams& p) {
  params_ = p;
  const auto set = [&](Loop loop, const PidGains& gains, double lower, double upper) {
    loops_[loop].configure(gains, p.derivative_time_constant, lower, upper);
  };
  set(kPosN, p.pos_n_to_vel, -p.max_horizontal_speed, p.max_horizontal_speed);
  set(kPosE, p.pos_e_to_vel, -p.max_horizontal_speed, p.max_horizontal_speed);
  set(kPosD, p.pos_d_to_vel, -p.max_climb_speed, p.max_descent_speed);
  set(kVelN, p.vel_n_to_accel, -p.max_horizontal_acceleration, p.max_horizontal_acceleration);
  set(kVelE, p.vel_e_to_accel, -p.max_horizontal_acceleration, p.max_horizontal_acceleration);
  set(kVelD, p.vel_d_to_accel, -p.max_climb_acceleration, p.max_descent_acceleration);
  set(kYawToRate, p.yaw_to_rate, -p.max_yaw_rate, p.max_yaw_rate);
  set(kRoll, p.roll_to_torque, -p.max_roll_torque, p.max_roll_torque);
  set(kPitch, p.pitch_to_torque, -p.max_pitch_torque, p.max_pitch_torque);
  set(kYaw, p.yaw_to_torque, -p.max_yaw_torque, p.max_yaw_torque);
  set(kRollRate, p.roll_rate_to_torque, -p.max_roll_torque, p.max_roll_torque);
  set(kPitchRate, p.pitch_rate_to_torque, -p.max_pitch_torque, p.max_pitch_torque);
  set(kYawRate, p.yaw_rate_to_torque, -p.max_yaw_torque, p.max_yaw_torque);
}

FcuCommand Cascade::fly(const ControlSetpoint& setpoint, const StateEstimate& estimate, const Step& step) {
  return run_loops(estimate, step,
                   [&] { return std::visit([this](const auto& entry) { return enter(entry); }, setpoint); });
}

FcuCommand Cascade::come_to(const Approach& approach, const StateEstimate& estimate, const Step& step) {
  return run_loops(estimate, step, [&] { return enter(approach); });
}

Vector3 Cascade::resting_place(const StateEstimate& estimate, double deceleration) const {
  const Vector2 v_N = estimate.v_NB_N().head<2>();
  const double speed = v_N.norm();
  Vector3 place_N = estimate.p_NB_N;
  if (speed > kSlow && stiffness() > 0.0) {
    place_N.head<2>() += approach_distance(speed, stiffness(), deceleration) / speed * v_N;
  }
  return place_N;
}

double Cascade::stiffness() const {
  return std::min(params_.pos_n_to_vel.kp, params_.pos_e_to_vel.kp);
}

FcuCommand Cascade::sink_level(double v_down, const StateEstimate& estimate, const Step& step) {
  return run_loops(estimate, step, [&] {
    const double v_D = estimate.v_NB_N().z();
    AccelerationHeadingRate next;
    next.a_V.z() = run_filtered(kVelD, v_down - v_D, v_D);
    return enter(next);
  });
}

template <class Enter>
FcuCommand Cascade::run_loops(const StateEstimate& estimate, const Step& step, Enter&& enter_at) {
  estimate_ = &estimate;
  step_ = step;
  lift_ = 0.0;
  asked_upright_.reset();
  const std::array<bool, kLoops> used_before = used_;
  used_.fill(false);
  const FcuCommand command = enter_at();
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (used_before[i] && !used_[i]) loops_[i].reset();
    if (used_[i] && !step.integrate) loops_[i].reset_integral();
  }
  aims_.fill(std::nullopt);
  estimate_ = nullptr;
  return command;
}

void Cascade::reset() {
  for (Pid& loop : loops_) loop.reset();
  aims_.fill(std::nullopt);
  lift_ = 0.0;
}

// A force along -Bz in the present attitude makes an acceleration: what the velocity loops have asked for.
void Cascade::resume(const FcuCommand& command, const StateEstimate& estimate) {
  double thrust = 0.0;  // N
  if (const auto* direct = std::get_if<PassThroughCommand>(&command)) {
    thrust = direct->thrust;
    aim_at(direct->M_B);
  } else if (const auto* angles = std::get_if<AngleCommand>(&command)) {
    thrust = angles->throttle / params_.equilibrium_throttle * params_.mass * params_.gravity;
  }
  if (thrust <= 0.0) return;
  const Vector3 a_NB_N =
      estimate.q_NB * Vector3(0.0, 0.0, -thrust / params_.mass) + Vector3(0.0, 0.0, params_.gravity);
  aims_[kVelN] = a_NB_N.x();
  aims_[kVelE] = a_NB_N.y();
  aims_[kVelD] = a_NB_N.z();
}

void Cascade::aim_at(const Vector3& torque_B) {
  for (const Loop loop : {kRoll, kRollRate}) aims_[loop] = torque_B.x();
  for (const Loop loop : {kPitch, kPitchRate}) aims_[loop] = torque_B.y();
  for (const Loop loop : {kYaw, kYawRate}) aims_[loop] = torque_B.z();
}

void Cascade::aim(Loop loop, double error, double rate) {
  if (aims_[loop] && step_.integrate) loops_[loop].aim(error, rate, *aims_[loop]);
}

double Cascade::run(Loop loop, double error, double rate) {
  used_[loop] = true;
  aim(loop, error, rate);
  return loops_[loop].run(error, rate, step_.dt, step_.integrate);
}

double Cascade::run_filtered(Loop loop, double error, double measurement) {
  used_[loop] = true;
  aim(loop, error, 0.0);
  return loops_[loop].run_filtered(error, measurement, step_.dt, step_.integrate);
}

double Cascade::yaw_rate_for(double heading) {
  return run(kYawToRate, shortest_difference(heading, estimate_->heading), estimate_->w_NB_B.z());
}

void Cascade::note_lean(double roll, double pitch) {
  asked_upright_ = std::cos(roll) * std::cos(pitch);
}

bool Cascade::near_ground() const {
  return std::abs(estimate_->p_NB_N.z()) < params_.min_altitude_for_attitude_control;
}

FcuCommand Cascade::enter(const PositionHeading& s) {
  const Vector3 error_N = s.p_N - estimate_->p_NB_N;
  const Vector3 v_NB_N = estimate_->v_NB_N();
  VelocityHeadingRate next;
  next.v_N << run(kPosN, error_N.x(), v_NB_N.x()), run(kPosE, error_N.y(), v_NB_N.y()),
      run(kPosD, error_N.z(), v_NB_N.z());
  next.heading_rate = yaw_rate_for(s.heading);
  return enter(next);
}

FcuCommand Cascade::enter(const VelocityHeightHeadingRate& s) {
  VelocityHeadingRate next;
  next.v_N << s.v_N, run(kPosD, s.down - estimate_->p_NB_N.z(), estimate_->v_NB_N().z());
  next.heading_rate = s.heading_rate;
  return enter(next);
}

FcuCommand Cascade::enter(const PositionClimbHeading& s) {
  const Vector2 error_N = s.p_N - estimate_->p_NB_N.head<2>();
  const Vector3 v_NB_N = estimate_->v_NB_N();
  VelocityHeadingRate next;
  next.v_N << run(kPosN, error_N.x(), v_NB_N.x()), run(kPosE, error_N.y(), v_NB_N.y()), s.v_down;
  next.heading_rate = yaw_rate_for(s.heading);
  return enter(next);
}

FcuCommand Cascade::enter(const Approach& s) {
  const Vector3 error_N = s.p_N - estimate_->p_NB_N;
  const Vector3 v_NB_N = estimate_->v_NB_N();
  const double distance = error_N.head<2>().norm();
  Vector2 wanted_N(run(kPosN, error_N.x(), v_NB_N.x()), run(kPosE, error_N.y(), v_NB_N.y()));
  const double speed = wanted_N.norm();
  const double closing = distance > 0.0 ? v_NB_N.head<2>().dot(error_N.head<2>()) / distance : 0.0;
  if (stiffness() > 0.0) {
    const double most = approach_speed(distance, stiffness(), s.deceleration);
    if (closing > params_.max_horizontal_speed) {
      // Who comes faster than it may fly brakes as on the rest of the way, not down to the limit at once.
      wanted_N = std::min(closing, most) / distance * error_N.head<2>();
    } else if (speed > most) {
      wanted_N *= most / speed;
    }
  }
  VelocityHeadingRate next;
  next.v_N << wanted_N, s.v_down ? *s.v_down : run(kPosD, error_N.z(), v_NB_N.z());
  next.heading_rate = yaw_rate_for(s.heading);
  return track(next, std::max(params_.max_horizontal_speed, closing));
}

FcuCommand Cascade::enter(const VelocityHeadingRate& s) {
  return track(s, params_.max_horizontal_speed);
}

FcuCommand Cascade::track(const VelocityHeadingRate& s, double max_horizontal_speed) {
  const Vector3 v_NB_N = estimate_->v_NB_N();
  const Vector3 wanted_N =
      limited(s.v_N, max_horizontal_speed, params_.max_climb_speed, params_.max_descent_speed);
  const double north = run_filtered(kVelN, wanted_N.x() - v_NB_N.x(), v_NB_N.x());
  const double east = run_filtered(kVelE, wanted_N.y() - v_NB_N.y(), v_NB_N.y());
  const double down = run_filtered(kVelD, wanted_N.z() - v_NB_N.z(), v_NB_N.z());
  const double c = std::cos(estimate_->heading);
  const double sine = std::sin(estimate_->heading);
  AccelerationHeadingRate next;
  next.a_V << c * north + sine * east, c * east - sine * north, down;
  next.heading_rate = s.heading_rate;
  return enter(next);
}

FcuCommand Cascade::enter(const AccelerationHeadingRate& s) {
  const Vector3 a_V = limited(s.a_V, params_.max_horizontal_acceleration, params_.max_climb_acceleration,
                              params_.max_descent_acceleration);
  const double lift = std::max(params_.gravity - a_V.z(), kSmallestLift * params_.gravity);  // m/s^2
  const double magnitude = std::sqrt(a_V.x() * a_V.x() + a_V.y() * a_V.y() + lift * lift);
  const double roll = std::asin(a_V.y() / magnitude);
  const double pitch = std::atan2(-a_V.x(), lift);
  const double upright =
      std::max(std::cos(estimate_->roll) * std::cos(estimate_->pitch), kSmallestTiltCosine);
  if (step_.thrust_in_newtons) {
    return enter(AngleHeadingRateThrust{roll, pitch, s.heading_rate, params_.mass * lift / upright});
  }
  const double throttle = params_.equilibrium_throttle * lift / params_.gravity / upright;
  return enter(AngleHeadingRateThrottle{roll, pitch, s.heading_rate, throttle});
}

FcuCommand Cascade::enter(const AngleHeadingThrottle& s) {
  return enter(AngleHeadingRateThrottle{s.roll, s.pitch, yaw_rate_for(s.heading), s.throttle});
}

FcuCommand Cascade::enter(const AngleHeadingRateThrottle& s) {
  AngleCommand command;
  command.throttle = std::clamp(s.throttle, params_.min_throttle, params_.max_throttle);
  lift_ = command.throttle / params_.equilibrium_throttle;
  if (near_ground()) return command;
  command.roll = limited(s.roll, params_.max_roll);
  command.pitch = limited(s.pitch, params_.max_pitch);
  note_lean(command.roll, command.pitch);
  command.heading_rate = limited(s.heading_rate, params_.max_yaw_rate);
  return command;
}

FcuCommand Cascade::enter(const RateThrottle& s) {
  RateCommand command;
  command.throttle = std::clamp(s.throttle, params_.min_throttle, params_.max_throttle);
  lift_ = command.throttle / params_.equilibrium_throttle;
  if (near_ground()) return command;
  command.w_NB_B << limited(s.w_NB_B.x(), params_.max_roll_rate),
      limited(s.w_NB_B.y(), params_.max_pitch_rate), limited(s.w_NB_B.z(), params_.max_yaw_rate);
  return command;
}

FcuCommand Cascade::enter(const TorqueThrust& s) {
  PassThroughCommand command;
  command.thrust = std::clamp(s.thrust, params_.min_thrust, params_.max_thrust);
  lift_ = command.thrust / (params_.mass * params_.gravity);
  if (near_ground()) return command;
  command.M_B << limited(s.M_B.x(), params_.max_roll_torque), limited(s.M_B.y(), params_.max_pitch_torque),
      limited(s.M_B.z(), params_.max_yaw_torque);
  return command;
}

FcuCommand Cascade::enter(const AngleHeadingThrust& s) {
  const Vector3& w_NB_B = estimate_->w_NB_B;
  const double roll = limited(s.roll, params_.max_roll);
  const double pitch = limited(s.pitch, params_.max_pitch);
  note_lean(roll, pitch);
  TorqueThrust next;
  next.M_B << run(kRoll, roll - estimate_->roll, w_NB_B.x()),
      run(kPitch, pitch - estimate_->pitch, w_NB_B.y()),
      run(kYaw, shortest_difference(s.heading, estimate_->heading), w_NB_B.z());
  next.thrust = s.thrust;
  return enter(next);
}

FcuCommand Cascade::enter(const AngleHeadingRateThrust& s) {
  const Vector3& w_NB_B = estimate_->w_NB_B;
  const double heading_rate = limited(s.heading_rate, params_.max_yaw_rate);
  const double roll = limited(s.roll, params_.max_roll);
  const double pitch = limited(s.pitch, params_.max_pitch);
  note_lean(roll, pitch);
  TorqueThrust next;
  next.M_B << run(kRoll, roll - estimate_->roll, w_NB_B.x()),
      run(kPitch, pitch - estimate_->pitch, w_NB_B.y()),
      run_filtered(kYawRate, heading_rate - w_NB_B.z(), w_NB_B.z());
  next.thrust = s.thrust;
  return enter(next);
}

FcuCommand Cascade::enter(const RateThrust& s) {
  const Vector3& w_NB_B = estimate_->w_NB_B;
  const Vector3 wanted_B(limited(s.w_NB_B.x(), params_.max_roll_rate),
                         limited(s.w_NB_B.y(), params_.max_pitch_rate),
                         limited(s.w_NB_B.z(), params_.max_yaw_rate));
  TorqueThrust next;
  next.M_B << run_filtered(kRollRate, wanted_B.x() - w_NB_B.x(), w_NB_B.x()),
      run_filtered(kPitchRate, wanted_B.y() - w_NB_B.y(), w_NB_B.y()),
      run_filtered(kYawRate, wanted_B.z() - w_NB_B.z(), w_NB_B.z());
  next.thrust = s.thrust;
  return enter(next);
}

}  // namespace ironbird::autopilot
