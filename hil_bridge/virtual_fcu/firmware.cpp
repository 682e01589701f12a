#include "hil_bridge/virtual_fcu/firmware.hpp"

#include <cmath>

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

// What no sensor on a vehicle can say: its squares would overflow, and the filters never forget.
constexpr float kMostAcceleration = 1.0e3F;  // m/s^2
constexpr float kMostRate = 1.0e2F;          // rad/s

/// Every component is a number within +-limit. False for NaN.
bool is_within(const Triple& v, float limit) {
  return std::fabs(v.x) <= limit && std::fabs(v.y) <= limit && std::fabs(v.z) <= limit;
}

}  // namespace

void Firmware::pass(Board& board) {
  telemetry_.begin_pass(board);
  now_us_ = board.clock_us;
  sensor_errors_ = board.sensor_errors;
  loop_time_us_ = board.loop_time_us;
  read_sensors(board);
  if (board.imu) control(board);
  stream(board);
  for (const rosflight::Message& message : board.received) handle(message);
  arming_.process_errors();
  report_changes();
  rc_decoded_ = false;
  if (board.rc) take_rc(*board.rc);
  if (arming_.failsafe()) {
    mux_.fly_failsafe();
  } else if (rc_decoded_) {
    mux_.update(rc_, now_ms());
  }
  if (mux_.overrides() != reported_overrides_) {
    reported_overrides_ = mux_.overrides();
    send_status();
  }
}

namespace {

/// The range of the barometer chips. Outside it the reading says nothing, and a density made of it would stop
/// the motors.
bool is_atmospheric(float pressure) {
  return pressure >= 10'000.0F && pressure <= 120'000.0F;
}

}  // namespace

void Firmware::read_sensors(Board& board) {
  if (board.imu) {
    const ImuInput rotated = corrections_.rotated(*board.imu);
    const bool sound =
        is_within(rotated.acceleration, kMostAcceleration) && is_within(rotated.angular_velocity, kMostRate);
    if (sound && calibrating_imu()) calibrate_imu(rotated);
    imu_before_us_ = imu_.stamp_us;
    imu_ = corrections_.corrected(rotated);
    if (sound) believed_imu_ = imu_;
    believed_imu_.stamp_us = imu_.stamp_us;
  }
  read_pressures(board);
  if (board.battery) battery_.add(*board.battery);
}

void Firmware::read_pressures(const Board& board) {
  if (board.baro && is_atmospheric(board.baro->pressure)) {
    pressure_ = board.baro->pressure;
    density_ = density_of(*pressure_);
  }
  if (board.differential_pressure && std::isfinite(board.differential_pressure->pressure)) {
    differential_pressure_ = board.differential_pressure->pressure;
  }
  if (pressure_ && baro_calibration_.running()) calibrate_pressure(baro_calibration_, *pressure_);
  if (differential_pressure_ && airspeed_calibration_.running()) {
    calibrate_pressure(airspeed_calibration_, *differential_pressure_);
  }
}

void Firmware::control(Board& board) {
  if (!imu_seen_) {
    imu_seen_ = true;
    return;
  }
  if (imu_.stamp_us < imu_before_us_) {
    set_error(kTimeGoingBackwards, true);
    return;
  }
  set_error(kTimeGoingBackwards, false);
  const float dt = static_cast<float>(imu_.stamp_us - imu_before_us_) * 1e-6F;
  filter_.step(believed_imu_, dt);
  set_error(kUnhealthyEstimator, filter_.unhealthy());
  mixer_inputs_ = controller_.run(mux_.combined(), filter_.attitude(), dt, arming_.armed());
  mixer_.mix(mixer_inputs_,
             {.armed = arming_.armed(),
              .overrides = mux_.overrides(),
              .density = density_,
              .battery_voltage = battery_.voltage()},
             telemetry_);
  board.outputs = mixer_.outputs();
}

void Firmware::stream(const Board& board) {
  if (telemetry_.listened()) {
    if (board.imu) send_imu_and_attitude();
    if (board.imu && telemetry_.output_due()) send_outputs(board);
    stream_slow_sensors(board);
  }
  if (telemetry_.heartbeat_due()) {
    const bool wing = parameters_.on(parameter("FIXED_WING"));
    telemetry_.send(rosflight::Heartbeat{.custom_mode = 0,
                                         .type = static_cast<std::uint8_t>(wing ? 1 : 2),
                                         .autopilot = 0,
                                         .base_mode = 0,
                                         .system_status = 0,
                                         .mavlink_version = rosflight::kDialectVersion});
  }
  if (telemetry_.status_due()) send_status();
  telemetry_.continue_parameter_list(parameters_);
  telemetry_.release_text();
}

void Firmware::take_rc(const RcFrame& frame) {
  send_rc_channels(frame);
  if (rc_.lost(frame)) {
    handle_event(Event::kRcLost);
    return;
  }
  handle_event(Event::kRcFound);
  rc_decoded_ = true;
  switch (rc_.decode(frame, now_ms(), arming_.armed())) {
    case Rc::Request::kArm:
      request_arm();
      break;
    case Rc::Request::kDisarm:
      handle_event(Event::kRequestDisarm);
      break;
    case Rc::Request::kNone:
      break;
  }
}

void Firmware::handle_event(Event event) {
  arming_.handle(event);
  report_changes();
}

void Firmware::request_arm() {
  const ArmingConditions conditions = {
      .throttle_low = rc_.throttle_low(),
      .throttle_protected = parameters_.on(parameter("TAKE_MIN_THR")) || rc_.on(Switch::kThrottleOverride),
      .calibrate_gyro = parameters_.on(parameter("ARM_CAL_GYRO"))};
  switch (arming_.request_arm(conditions)) {
    case ArmingReply::kThrottleHigh:
      telemetry_.write(Severity::kError, "arming refused: throttle stick too high");
      break;
    case ArmingReply::kUnprotected:
      telemetry_.write(Severity::kError, "arming refused: RC throttle override is off");
      break;
    case ArmingReply::kRefused:
      explain_refusal();
      break;
    case ArmingReply::kCalibrating:
      start_gyro_calibration();
      break;
    case ArmingReply::kIgnored:
    case ArmingReply::kArmed:
      break;
  }
  report_changes();
}

void Firmware::explain_refusal() {
  struct Reason {
    ErrorBit bit;
    std::string_view text;
  };
  constexpr Reason kReasons[] = {{kInvalidMixer, "arming refused: no valid mixer"},
                                 {kImuNotResponding, "arming refused: IMU is silent"},
                                 {kErrorRcLost, "arming refused: RC is lost"},
                                 {kUnhealthyEstimator, "arming refused: attitude filter unhealthy"},
                                 {kTimeGoingBackwards, "arming refused: time runs backwards"},
                                 {kUncalibratedImu, "arming refused: IMU is not calibrated"},
                                 {kBufferOverrun, "arming refused: a buffer ran over"},
                                 {kInvalidFailsafe, "arming refused: FAILSAFE_THR outside 0..1"}};
  constexpr std::uint32_t kPauseMs = 1000;
  if (refusal_explained_ && now_ms() - refusal_explained_ms_ <= kPauseMs) return;
  refusal_explained_ = true;
  refusal_explained_ms_ = now_ms();
  for (const Reason& reason : kReasons) {
    if ((arming_.errors() & reason.bit) != 0) telemetry_.write(Severity::kError, reason.text);
  }
}

void Firmware::set_error(ErrorBit bit, bool present) {
  if (present == ((arming_.errors() & bit) != 0)) return;
  if (present) {
    arming_.set_error(bit);
  } else {
    arming_.clear_error(bit);
  }
  report_changes();
}

void Firmware::report_changes() {
  if (arming_.take_change()) send_status();
}

}  // namespace ironbird::hil_bridge::virtual_fcu
