#include "hil_bridge/virtual_fcu/firmware_host.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ironbird::hil_bridge {

using virtual_fcu::Triple;

namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::int64_t kUnixStart =
    1'767'225'600;  // s, Unix time at the start of a run: 2026-01-01 00:00 UTC
constexpr std::size_t kRoomForMessages = 1024;

void check_whole_ticks(const char* key, Time value, Time tick) {
  if (value.count() >= 0 && value % tick == Time::zero()) return;
  throw std::invalid_argument(std::string("fcu.") + key + " = " + std::to_string(value.count()) +
                              " ns, must be a whole number of ticks of " + std::to_string(tick.count()) +
                              " ns");
}

VirtualFcuConfig checked(const VirtualFcuConfig& config) {
  if (config.tick <= Time::zero() || config.tick % std::chrono::microseconds(1) != Time::zero()) {
    throw std::invalid_argument("fcu.tick = " + std::to_string(config.tick.count()) +
                                " ns, must be a whole number of microseconds, > 0");
  }
  check_whole_ticks("uplink_latency", config.uplink_latency, config.tick);
  check_whole_ticks("downlink_latency", config.downlink_latency, config.tick);
  if (!(config.pwm_resolution >= 0.0 && config.pwm_resolution <= 0.1)) {
    throw std::invalid_argument("fcu.pwm_resolution = " + std::to_string(config.pwm_resolution) +
                                ", must be within 0..0.1");
  }
  return config;
}

Time rc_period(const VirtualFcuConfig& config) {
  if (!(config.rc_rate >= 0.1 && config.rc_rate <= 1000.0)) {
    throw std::invalid_argument("fcu.rc_rate = " + std::to_string(config.rc_rate) +
                                " Hz, must be within 0.1..1000");
  }
  const double ticks = 1e9 / config.rc_rate / static_cast<double>(config.tick.count());
  const double whole = std::round(ticks);
  if (whole < 1.0 || std::fabs(ticks - whole) > VirtualFcuConfig::kRcTolerance * whole) {
    throw std::invalid_argument("fcu.rc_rate = " + std::to_string(config.rc_rate) +
                                " Hz, must have a period of whole ticks");
  }
  return config.tick * static_cast<std::int64_t>(whole);
}

std::uint64_t microseconds(Time time) {
  return static_cast<std::uint64_t>(time.count() / 1000);
}

Triple triple(const simulator::Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

rosflight::RosflightGnss gnss_message(const simulator::GnssReading& reading) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return {.seconds = kUnixStart + reading.taken.count() / kNanoseconds,
          .lat = reading.latitude * kDegrees,
          .lon = reading.longitude * kDegrees,
          .rosflight_timestamp = microseconds(reading.taken),
          .nanos = static_cast<std::int32_t>(reading.taken.count() % kNanoseconds),
          .height = static_cast<float>(reading.altitude),
          .vel_n = static_cast<float>(reading.v_NB_N.x()),
          .vel_e = static_cast<float>(reading.v_NB_N.y()),
          .vel_d = static_cast<float>(reading.v_NB_N.z()),
          .h_acc = static_cast<float>(reading.horizontal_accuracy),
          .v_acc = static_cast<float>(reading.vertical_accuracy),
          .s_acc = static_cast<float>(reading.speed_accuracy),
          .fix_type = static_cast<std::uint8_t>(reading.fix),
          .num_sat = static_cast<std::uint8_t>(reading.satellites)};
}

}  // namespace

FirmwareHost::FirmwareHost(const VirtualFcuConfig& config)
    : config_(checked(config)),
      rc_period_(rc_period(config)),
      firmware_(config.parameters, config.undefined_when_inverted) {
  uplink_.reserve(kRoomForMessages);
  uplink_arrivals_.reserve(kRoomForMessages);
  downlink_.reserve(kRoomForMessages);
  board_.sent = &downlink_;
  if (config.calibrate_imu_at_start) send(rosflight::RosflightCmd{.command = rosflight::kCalibrateImu});
}

void FirmwareHost::tick(const simulator::Readings& readings, Time now) {
  now_ = now;
  board_.clock_us = microseconds(now);
  board_.sent_arrival = now + config_.downlink_latency;
  board_.clear_inputs();
  take_messages();
  take_rc();
  if (config_.two_passes) {
    firmware_.pass(board_);
    board_.clear_inputs();
    if (config_.rc_every_pass) take_rc();
  }
  take_readings(readings);
  firmware_.pass(board_);
  drop_messages();
}

void FirmwareHost::take_messages() {
  // What left the companion after the last tick has arrived before this one, hence the strict comparison.
  const auto end = std::lower_bound(uplink_arrivals_.begin(), uplink_arrivals_.end(), now_);
  delivered_ = static_cast<std::size_t>(end - uplink_arrivals_.begin());
  board_.received = std::span(uplink_).first(delivered_);
}

void FirmwareHost::drop_messages() {
  if (delivered_ == 0) return;
  const auto count = static_cast<std::ptrdiff_t>(delivered_);
  uplink_.erase(uplink_.begin(), uplink_.begin() + count);
  uplink_arrivals_.erase(uplink_arrivals_.begin(), uplink_arrivals_.begin() + count);
  delivered_ = 0;
}

void FirmwareHost::take_rc() {
  if (config_.rc_every_pass || now_ % rc_period_ == Time::zero()) board_.rc = pilot_.frame(firmware_, now_);
}

void FirmwareHost::take_readings(const simulator::Readings& readings) {
  if (readings.imu) {
    board_.imu = virtual_fcu::ImuInput{.stamp_us = microseconds(readings.imu->taken),
                                       .acceleration = triple(readings.imu->f_B),
                                       .angular_velocity = triple(readings.imu->w_NB_B),
                                       .temperature = static_cast<float>(readings.imu->temperature)};
  }
  if (readings.mag) board_.mag = triple(readings.mag->m_B);
  if (readings.baro) {
    board_.baro = virtual_fcu::PressureInput{static_cast<float>(readings.baro->pressure),
                                             static_cast<float>(readings.baro->temperature)};
  }
  if (readings.airspeed) {
    board_.differential_pressure =
        virtual_fcu::PressureInput{static_cast<float>(readings.airspeed->differential_pressure),
                                   static_cast<float>(readings.airspeed->temperature)};
  }
  if (readings.range) board_.range = static_cast<float>(readings.range->range);
  if (readings.gnss) board_.gnss = gnss_message(*readings.gnss);
  if (readings.battery) {
    board_.battery = virtual_fcu::BatteryInput{static_cast<float>(readings.battery->voltage),
                                               static_cast<float>(readings.battery->current)};
  }
}

simulator::RotorCommands FirmwareHost::commands() const {
  simulator::RotorCommands commands;
  const double step = config_.pwm_resolution;
  for (std::size_t k = 0; k < commands.throttle.size(); ++k) {
    const double output = static_cast<double>(board_.outputs[k]);
    if (!(output > 0.0)) continue;
    commands.throttle[k] = step > 0.0 ? std::floor(output / step) * step : output;
  }
  return commands;
}

void FirmwareHost::receive(std::vector<Arrival>& out) {
  const auto end = std::find_if(downlink_.begin(), downlink_.end(),
                                [this](const Arrival& arrival) { return arrival.when > now_; });
  out.insert(out.end(), downlink_.begin(), end);
  downlink_.erase(downlink_.begin(), end);
}

void FirmwareHost::send(const rosflight::Message& message) {
  uplink_.push_back(message);
  uplink_arrivals_.push_back(now_ + config_.uplink_latency);
}

}  // namespace ironbird::hil_bridge
