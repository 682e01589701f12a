#include "hil_bridge/translate/sensor_frame_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ironbird::hil_bridge {

namespace {

using autopilot::Vector3;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

Vector3 vector(float x, float y, float z) {
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

}  // namespace

const autopilot::SensorFrame* SensorFrameBuilder::push(const Arrival& arrival) {
  if (const auto* imu = std::get_if<rosflight::SmallImu>(&arrival.message)) {
    imu_stamp_ = rosflight::clock_of(imu->time_boot_us);
    gathering_.imu.stamp = imu_stamp_;
    gathering_.imu.f_B = vector(imu->xacc, imu->yacc, imu->zacc);
    gathering_.imu.w_NB_B = vector(imu->xgyro, imu->ygyro, imu->zgyro);
    complete_ = gathering_;
    gathering_ = {};
    return &complete_;
  }
  if (const auto* mag = std::get_if<rosflight::SmallMag>(&arrival.message)) {
    take(*mag);
  } else if (const auto* baro = std::get_if<rosflight::SmallBaro>(&arrival.message)) {
    take(*baro);
  } else if (const auto* gnss = std::get_if<rosflight::RosflightGnss>(&arrival.message)) {
    take(*gnss);
  } else if (const auto* status = std::get_if<rosflight::RosflightStatus>(&arrival.message)) {
    take(*status, arrival.when);
  } else if (const auto* outputs = std::get_if<rosflight::RosflightOutputRaw>(&arrival.message)) {
    take(*outputs, arrival.when);
  } else if (const auto* battery = std::get_if<rosflight::RosflightBatteryStatus>(&arrival.message)) {
    if (std::isfinite(battery->battery_voltage))
      battery_voltage_ = static_cast<double>(battery->battery_voltage);
  }
  return nullptr;
}

void SensorFrameBuilder::take(const rosflight::SmallMag& message) {
  autopilot::MagSample sample;
  sample.stamp = imu_stamp_;
  sample.m_B = vector(message.xmag, message.ymag, message.zmag);
  if (!sample.m_B.allFinite()) {
    return;
  }
  gathering_.mag = sample;
}

void SensorFrameBuilder::take(const rosflight::SmallBaro& message) {
  autopilot::BaroSample sample;
  sample.stamp = imu_stamp_;
  sample.pressure = static_cast<double>(message.pressure);
  sample.temperature = static_cast<double>(message.temperature);
  if (!std::isfinite(sample.pressure)) {
    return;
  }
  gathering_.baro = sample;
}

void SensorFrameBuilder::take(const rosflight::RosflightGnss& message) {
  autopilot::GnssSample sample;
  sample.stamp = rosflight::clock_of(message.rosflight_timestamp);
  sample.latitude = message.lat * kRadiansPerDegree;
  sample.longitude = message.lon * kRadiansPerDegree;
  sample.altitude = static_cast<double>(message.height);
  sample.v_NB_N = vector(message.vel_n, message.vel_e, message.vel_d);
  sample.horizontal_accuracy = static_cast<double>(message.h_acc);
  sample.vertical_accuracy = static_cast<double>(message.v_acc);
  sample.speed_accuracy = static_cast<double>(message.s_acc);
  sample.fix =
      message.fix_type <= 7 ? static_cast<autopilot::GnssFix>(message.fix_type) : autopilot::GnssFix::kNone;
  sample.satellites = message.num_sat;
  if (!std::isfinite(sample.latitude) || !std::isfinite(sample.longitude) ||
      !std::isfinite(sample.altitude) || !sample.v_NB_N.allFinite()) {
    return;
  }
  gathering_.gnss = sample;
}

void SensorFrameBuilder::take(const rosflight::RosflightStatus& message, Time when) {
  autopilot::FcuStatus status;
  status.stamp = when;
  status.armed = message.armed != 0;
  status.failsafe = message.failsafe != 0;
  status.offboard = message.offboard != 0;
  status.rc_override = message.rc_override;
  status.error_code = message.error_code;
  status.imu_calibrated = (message.error_code & rosflight::kUncalibratedImu) == 0;
  status.battery_voltage = battery_voltage_;
  status.greatest_output = greatest_output_;
  status.output_stamp = output_stamp_;
  status_ = gathering_.status = status;
}

void SensorFrameBuilder::take(const rosflight::RosflightOutputRaw& message, Time when) {
  const float greatest = *std::max_element(message.values.begin(), message.values.end());
  if (!std::isfinite(greatest)) return;
  greatest_output_ = static_cast<double>(greatest);
  output_stamp_ = when;
  if (!status_) return;
  status_->greatest_output = greatest_output_;
  status_->output_stamp = output_stamp_;
  gathering_.status = status_;
}

}  // namespace ironbird::hil_bridge
