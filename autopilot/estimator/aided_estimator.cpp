#include "autopilot/estimator/aided_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "autopilot/handover.hpp"
#include "autopilot/math/euler_zyx.hpp"
#include "autopilot/math/local_map.hpp"
#include "autopilot/math/standard_atmosphere.hpp"

namespace ironbird::autopilot {

namespace {

constexpr double kLongestStep = 0.02;  // s, a longer gap between IMU samples is crossed in several steps
constexpr double kImuSilence = 0.05;   // s
constexpr double kSoonAgain = 15.0;    // s, between two resets of velocity or heading
constexpr double kFreshFix = 1.0;      // s, a fix that may still replace a broken state

/// A start in motion from what was last known, in full: the accelerometer's bias as well.
StartState going_on_from(const StateEstimate& last, const LocalOrigin& origin) {
  StartState found;
  found.origin = origin;
  found.p_NB_N = last.p_NB_N;
  found.v_NB_N = last.v_NB_N();
  found.q_NB = last.q_NB;
  found.gyro_bias_B = last.gyro_bias_B;
  found.accelerometer_offset_B = last.accelerometer_bias_B;
  found.moving = true;
  return found;
}

}  // namespace

void AidedEstimator::reset() {
  Estimator::reset();
  alignment_.reset();
  running_ = false;
  realigning_ = false;
  on_ground_ = false;
  attitude_lost_ = false;
  seen_resets_ = 0;
  last_reset_ = Time{0};
  origin_ = LocalOrigin{};
  baro_ = BaroModel{};
  origin_pressure_.reset();
  accelerometer_offset_B_.setZero();
  w_filtered_B_.setZero();
  rates_known_ = false;
  vibration_ = VibrationWatch{};
  delay_line_.clear();
  gates_ = Gates{};
  heard_ = Heard{};
  previous_ = Time{0};
  innovations_ = Innovations{};
  reaches_ = Innovations{};
  last_fix_.reset();
  trust_ = FixTrust{};
  offset_N_.setZero();
  back_since_.reset();
  doubts_ = 0;
  was_armed_ = false;
  last_good_ = StateEstimate{};
  late_fixes_ = 0;
  recoveries_ = 0;
  realignments_ = 0;
}

void AidedEstimator::begin(const StartState& found, Time now) {
  origin_ = found.origin;
  rebuild_baro_model();
  heard_ = {now, now, now};
  trust_.begin(now);
  restart(found);
  on_ground_ = !found.moving;
  running_ = true;
}

void AidedEstimator::rebuild_baro_model() {
  const double given = aiding().baro.air_density;
  baro_.gravity = aiding().gravity;
  baro_.density = given > 0.0 ? given : standard_density(origin_.altitude);
  baro_.density_gradient = given > 0.0 ? 0.0 : standard_density_gradient(origin_.altitude);
}

std::string AidedEstimator::objection(const Signals& signals) const {
  const FlightPhase phase = signals.flight.phase;
  if (phase == FlightPhase::kDisarmed || phase == FlightPhase::kSilent) return {};
  const StateEstimate& last = signals.estimate;
  if (last.health == Health::kUninitialised) return "in flight there must be an estimate to start from";
  return last.origin.known ? "" : "in flight it needs an estimate whose origin on the earth is known";
}

void AidedEstimator::take_over(const Handover& left) {
  Estimator::take_over(left);
  const StateEstimate& last = left.estimate;
  if (last.health == Health::kLost) alignment_.restart_in_motion();
  if (last.health == Health::kUninitialised || last.health == Health::kLost || !last.origin.known) return;
  origin_pressure_.reset();
  begin(going_on_from(last, last.origin), last.stamp);
  heard_.gnss = last.stamp - Time{std::llround(last.position_age * 1e9)};
  trust_.begin(heard_.gnss);
  offset_N_ = last.position_offset_N;
  doubts_ = last.position_doubtful ? 1 : 0;
  was_armed_ = was_armed_ || left.flight.fcu.armed || last.position_doubtful;
  previous_ = last.stamp;
  last_good_ = last;
}

StateEstimate AidedEstimator::estimate(const SensorFrame& frame, double dt) {
  const Time now = frame.imu.stamp;
  // The module that was replaced may have run until just now.
  const double step = running_ && previous_.count() > 0 ? seconds(now - previous_) : dt;
  previous_ = now;
  filter_rates(frame.imu.w_NB_B, step);
  if (frame.status) was_armed_ = was_armed_ || frame.status->armed;
  if (!running_) {
    if (alignment_.add(frame, dt, aiding())) {
      origin_pressure_ = alignment_.start().origin_pressure;
      begin(alignment_.start(), now);
    }
  } else {
    advance(frame.imu, step);
    settle_on_ground();
    leave_ground();
    fuse(frame);
    if (!is_finite()) recover(now);
    if (imu_was_away()) seek_attitude();
    realign_if_hopeless(frame, step);
  }
  StateEstimate out;
  out.stamp = now;
  out.w_NB_B = w_filtered_B_;
  if (!running_) return out;
  publish(out);
  out.w_NB_B -= out.gyro_bias_B;
  out.accelerometer_bias_B += accelerometer_offset_B_;
  out.origin = origin_;
  look_after(out, now, step);
  return out;
}

void AidedEstimator::filter_rates(const Vector3& w_B, double dt) {
  const double cutoff = aiding().gyro_cutoff;
  if (!rates_known_ || cutoff <= 0.0) {
    w_filtered_B_ = w_B;
    rates_known_ = true;
    return;
  }
  const double kept = std::exp(-2.0 * std::numbers::pi * cutoff * dt);
  w_filtered_B_ = kept * w_filtered_B_ + (1.0 - kept) * w_B;
}

void AidedEstimator::advance(const ImuSample& imu, double dt) {
  if (dt <= 0.0) return;
  vibration_.add(imu.f_B, dt);
  const double crossed = std::min(dt, seconds(FrameClock::kLongestGap));
  const int steps = static_cast<int>(std::ceil(crossed / kLongestStep));
  const Vector3 f_B = imu.f_B - accelerometer_offset_B_;
  for (int i = 0; i < steps; ++i) predict(f_B, imu.w_NB_B, crossed / steps);
  if (!aiding().gnss.latency_compensation) return;
  const Kinematics here = kinematics();
  delay_line_.push(imu.stamp, here.p_N, here.v_N);
}

template <class Correction>
void AidedEstimator::tell_delay_line(Correction&& correction) {
  if (!aiding().gnss.latency_compensation) {
    correction();
    return;
  }
  const Kinematics before = kinematics();
  correction();
  const Kinematics after = kinematics();
  delay_line_.correct(after.p_N - before.p_N, after.v_N - before.v_N);
}

void AidedEstimator::fuse(const SensorFrame& frame) {
  const Time now = frame.imu.stamp;
  if (frame.mag) {
    heard_.mag = now;
    tell_delay_line([&] { correct_mag(frame.mag->m_B.normalized(), now); });
  }
  if (frame.baro) fuse_baro(*frame.baro, now);
  if (frame.gnss && is_usable(frame.gnss->fix)) fuse_gnss(*frame.gnss, now);
}

void AidedEstimator::fuse_baro(const BaroSample& baro, Time now) {
  heard_.baro = now;
  rebuild_baro_model();
  if (!origin_pressure_) {
    // After a take-over: the pressure at height 0 is the one that makes this sample agree.
    origin_pressure_ = baro.pressure + baro_.pressure_difference(kinematics().p_N.z());
  }
  tell_delay_line([&] { correct_baro(*origin_pressure_ - baro.pressure, now); });
}

void AidedEstimator::fuse_gnss(const GnssSample& gnss, Time now) {
  const GnssParams& wanted = aiding().gnss;
  const Kinematics present = kinematics();
  Kinematics compared = present;
  if (wanted.latency_compensation && gnss.stamp < now) {
    const std::optional<DelayLine::Past> past = delay_line_.at(gnss.stamp);
    if (!past) {
      ++late_fixes_;
      return;
    }
    compared = *past;
  }
  heard_.gnss = now;
  GnssObservation fix;
  fix.p_N = local_from_geodetic({gnss.latitude, gnss.longitude, gnss.altitude}, origin_);
  weigh(fix, gnss, wanted);
  const Vector3 as_told_N = fix.p_N - compared.p_N - slow_fix_error_N();
  if (!has_stepped_back(as_told_N, fix.gate_variance_p, now)) fix.p_N -= offset_N_;
  fix.dp_N = fix.p_N - compared.p_N;
  fix.dv_N = gnss.v_NB_N - compared.v_N;
  fix.p_N += present.p_N - compared.p_N;
  fix.v_N = gnss.v_NB_N + present.v_N - compared.v_N;
  innovations_.p_N = fix.dp_N;
  innovations_.v_N = fix.dv_N;
  last_fix_ = fix;
  tell_delay_line([&] { correct_gnss(fix, now); });
}

bool AidedEstimator::has_stepped_back(const Vector3& as_told_N, const Vector3& variance, Time now) {
  if (offset_N_.isZero(0.0)) return false;
  const GnssParams& wanted = aiding().gnss;
  const Vector2 step = as_told_N.head<2>();
  const Vector2 S = variance.head<2>() + last_good_.sigma_p_N.head<2>().cwiseAbs2();
  const double nis = step.cwiseAbs2().cwiseQuotient(S).sum();
  const bool nearer = step.squaredNorm() < (step - offset_N_.head<2>()).squaredNorm();
  if (!nearer || (wanted.position_gate > 0.0 && nis > wanted.position_gate)) {
    back_since_.reset();
    return false;
  }
  if (!back_since_) back_since_ = now;
  if (seconds(now - *back_since_) >= wanted.persistence * doubts_) {
    offset_N_.setZero();
    back_since_.reset();
  }
  return true;
}

void AidedEstimator::velocity_believed(Time now, double was_off) {
  if (was_off > 0.0) heading_trust_.doubt();
  // In the meantime it may have been more than at the end.
  trust_.velocity_believed(now, std::max(2.0 * was_off, aiding().lost_speed), aiding().gnss.silence);
}

bool AidedEstimator::velocity_disputed(Time now) const {
  return gates_.velocity.disagreed_within(aiding().gnss.silence, now);
}

double AidedEstimator::height_lost(double was_off_down) const {
  return was_off_down * aiding().gnss.persistence;
}

bool AidedEstimator::blame_receiver(const Vector3& by_N, Time now) {
  const double distance = by_N.head<2>().norm();
  const bool far = distance > PositionWatch::kLeastJump;
  if (!far || !trust_.blames_receiver(distance, aiding().lost_speed, now, aiding().gnss.silence))
    return false;
  if (offset_N_.isZero(0.0)) ++doubts_;
  offset_N_.head<2>() += by_N.head<2>();
  if (last_fix_) last_fix_->p_N.head<2>() -= by_N.head<2>();
  settle_on_ground();
  return true;
}

void AidedEstimator::settle_on_ground() {
  // Before a flight nothing hangs on the old place: N stays with the vehicle and lies where the fixes say.
  if (was_armed_ || offset_N_.isZero(0.0)) return;
  const GeodeticPosition place = geodetic_from_local(offset_N_, origin_);
  origin_.latitude = place.latitude;
  origin_.longitude = place.longitude;
  offset_N_.setZero();
  doubts_ = 0;
}

void AidedEstimator::leave_ground() {
  const MagParams& wanted = aiding().mag;
  if (!on_ground_ || -kinematics().p_N.z() < wanted.ground_height) return;
  on_ground_ = false;
  if (wanted.ground_sigma <= 0.0) return;
  heading_trust_.doubt();
  doubt_heading(wanted.ground_sigma);
}

void AidedEstimator::recover(Time now) {
  ++recoveries_;
  StartState again = going_on_from(last_good_, origin_);
  if (last_fix_ && seconds(now - heard_.gnss) < kFreshFix) {
    again.p_NB_N.head<2>() = last_fix_->p_N.head<2>();
    again.v_NB_N = last_fix_->v_N;
  }
  restart(again);
}

void AidedEstimator::restart(const StartState& again) {
  accelerometer_offset_B_ = again.accelerometer_offset_B;
  delay_line_.clear();
  heading_trust_.doubt();
  start(again);
}

void AidedEstimator::seek_attitude() {
  // Where the vehicle turned to in the meantime no covariance can tell: as unsure as at a start in motion.
  StateEstimate here;
  publish(here);
  here.accelerometer_bias_B += accelerometer_offset_B_;
  restart(going_on_from(here, origin_));
  attitude_lost_ = true;
  realigning_ = true;
  alignment_.restart_in_motion();
}

void AidedEstimator::realign_if_hopeless(const SensorFrame& frame, double dt) {
  const Time now = frame.imu.stamp;
  const int resets = gates_.velocity.resets() + gates_.mag.resets();
  if (resets > seen_resets_) {
    // One reset may be the sensor's fault. A second one soon after means that the attitude is wrong.
    if (seen_resets_ > 0 && seconds(now - last_reset_) < kSoonAgain && !realigning_) {
      realigning_ = true;
      alignment_.restart_in_motion();
    }
    seen_resets_ = resets;
    last_reset_ = now;
  }
  if (!realigning_ || !alignment_.add(frame, dt, aiding())) return;
  realigning_ = false;
  attitude_lost_ = false;
  ++realignments_;
  StartState again = alignment_.start();
  const GeodeticPosition place = geodetic_from_local(again.p_NB_N, again.origin);
  again.p_NB_N.head<2>() =
      local_from_geodetic(place.latitude, place.longitude, origin_) - offset_N_.head<2>();
  again.p_NB_N.z() = kinematics().p_N.z();  // the barometer has gone on correcting the height
  again.origin = origin_;
  StateEstimate before;
  publish(before);
  again.accelerometer_offset_B = accelerometer_offset_B_ + before.accelerometer_bias_B;
  again.moving = true;
  restart(again);
}

void AidedEstimator::look_after(StateEstimate& estimate, Time now, double dt) {
  const AidingParams& wanted = aiding();
  const bool silent = seconds(now - heard_.mag) > wanted.mag.silence ||
                      seconds(now - heard_.baro) > wanted.baro.silence ||
                      seconds(now - heard_.gnss) > wanted.gnss.silence || dt > kImuSilence;
  const bool refusing = gates_.position.disagreeing() || gates_.velocity.disagreeing() ||
                        gates_.baro.disagreeing() || gates_.mag.disagreeing() || realigning_;
  estimate.position_offset_N = offset_N_;
  estimate.position_doubtful = !offset_N_.isZero(0.0);
  estimate.health = silent || refusing || estimate.position_doubtful ? Health::kDegraded : Health::kGood;
  estimate.position_age = std::max(0.0, seconds(now - heard_.gnss));
  estimate.position_known =
      estimate.position_age <= wanted.gnss.coast && estimate.sigma_v_B.maxCoeff() <= wanted.lost_speed;
  if (is_lost(estimate, now)) {
    estimate.health = Health::kLost;
    return;
  }
  last_good_ = estimate;
}

bool AidedEstimator::is_lost(const StateEstimate& estimate, Time now) const {
  const AidingParams& wanted = aiding();
  const bool no_height =
      estimate.position_age > wanted.gnss.coast && seconds(now - heard_.baro) > wanted.gnss.coast;
  return attitude_lost_ || no_height || estimate.sigma_p_N.z() > wanted.lost_height ||
         estimate.sigma_attitude.head<2>().maxCoeff() > wanted.lost_tilt;
}

void AidedEstimator::probe(ProbeVisitor& visit) const {
  visit("innovation_position", innovations_.p_N, "m");
  visit("innovation_velocity", innovations_.v_N, "m/s");
  visit("innovation_pressure", innovations_.pressure, "Pa");
  visit("innovation_heading", innovations_.heading, "rad");
  visit("gate_position", reaches_.p_N, "m");
  visit("gate_velocity", reaches_.v_N, "m/s");
  visit("gate_pressure", reaches_.pressure, "Pa");
  visit("gate_heading", reaches_.heading, "rad");
  visit("nis_position", gates_.position.nis(), "1");
  visit("nis_velocity", gates_.velocity.nis(), "1");
  visit("nis_baro", gates_.baro.nis(), "1");
  visit("nis_mag", gates_.mag.nis(), "1");
  visit("rejected_position", gates_.position.rejected(), "1");
  visit("rejected_velocity", gates_.velocity.rejected(), "1");
  visit("rejected_baro", gates_.baro.rejected(), "1");
  visit("rejected_mag", gates_.mag.rejected(), "1");
  visit("resets",
        gates_.position.resets() + gates_.velocity.resets() + gates_.baro.resets() + gates_.mag.resets(),
        "1");
  visit("vibration", vibration(), "m/s^2");
  visit("position_offset", offset_N_, "m");
  visit("late_fixes", late_fixes_, "1");
  visit("recoveries", recoveries_, "1");
  visit("realignments", realignments_, "1");
  visit("accelerometer_offset", accelerometer_offset_B_, "m/s^2");
  visit("origin_pressure", origin_pressure_.value_or(0.0), "Pa");
  probe_filter(visit);
}

}  // namespace ironbird::autopilot
