#include <algorithm>
#include <variant>

#include "hil_bridge/virtual_fcu/firmware.hpp"

// Messages to and from the companion.

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr std::string_view kVersion = "v2.0.1-ironbird";

}  // namespace

void Firmware::send_imu_and_attitude() {
  telemetry_.send(rosflight::SmallImu{.time_boot_us = imu_.stamp_us,
                                      .xacc = imu_.acceleration.x,
                                      .yacc = imu_.acceleration.y,
                                      .zacc = imu_.acceleration.z,
                                      .xgyro = imu_.angular_velocity.x,
                                      .ygyro = imu_.angular_velocity.y,
                                      .zgyro = imu_.angular_velocity.z,
                                      .temperature = imu_.temperature});
  const Attitude& attitude = filter_.attitude();
  telemetry_.send(
      rosflight::AttitudeQuaternion{.time_boot_ms = static_cast<std::uint32_t>(imu_.stamp_us / 1000U),
                                    .q1 = attitude.q_NB.w,
                                    .q2 = attitude.q_NB.x,
                                    .q3 = attitude.q_NB.y,
                                    .q4 = attitude.q_NB.z,
                                    .rollspeed = attitude.w_NB_B.x,
                                    .pitchspeed = attitude.w_NB_B.y,
                                    .yawspeed = attitude.w_NB_B.z});
}

void Firmware::send_outputs(const Board& board) {
  telemetry_.send(rosflight::RosflightOutputRaw{.stamp = now_us_ / 1000U, .values = board.outputs});
}

void Firmware::stream_slow_sensors(const Board& board) {
  if (board.gnss) telemetry_.send(*board.gnss);
  if (board.baro) {
    telemetry_.send(rosflight::SmallBaro{.altitude = pressure_altitude(board.baro->pressure),
                                         .pressure = board.baro->pressure,
                                         .temperature = board.baro->temperature});
  }
  if (board.mag) {
    const Triple field = corrections_.magnetic(*board.mag);
    telemetry_.send(rosflight::SmallMag{.xmag = field.x, .ymag = field.y, .zmag = field.z});
  }
  if (board.differential_pressure) {
    const float pressure = corrections_.differential_pressure(board.differential_pressure->pressure);
    telemetry_.send(rosflight::DiffPressure{.velocity = indicated_airspeed(pressure),
                                            .diff_pressure = pressure,
                                            .temperature = board.differential_pressure->temperature});
  }
  if (board.range) {
    telemetry_.send(
        rosflight::SmallRange{.range = *board.range, .max_range = 8.0F, .min_range = 0.25F, .type = 0});
  }
  if (board.battery) {
    telemetry_.send(rosflight::RosflightBatteryStatus{.battery_voltage = battery_.voltage(),
                                                      .battery_current = battery_.current()});
  }
}

void Firmware::send_status() {
  if (!telemetry_.listened()) return;
  const ChannelKind roll = mux_.combined().u[kRoll].kind;
  const bool direct = parameters_.on(parameter("FIXED_WING")) || roll == ChannelKind::kPassThrough;
  const int mode = direct ? 0 : roll == ChannelKind::kAngle ? 2 : 1;
  telemetry_.send(rosflight::RosflightStatus{.rc_override = mux_.overrides(),
                                             .num_errors = sensor_errors_,
                                             .loop_time_us = loop_time_us_,
                                             .armed = arming_.armed(),
                                             .failsafe = arming_.failsafe(),
                                             .offboard = mux_.offboard(),
                                             .error_code = static_cast<std::uint8_t>(arming_.errors()),
                                             .control_mode = static_cast<std::uint8_t>(mode)});
}

void Firmware::send_rc_channels(const RcFrame& frame) {
  if (!telemetry_.listened()) return;
  constexpr std::size_t kReported = 8;
  rosflight::RcChannels message{};
  message.time_boot_ms = now_ms();
  for (std::size_t k = 0; k < kReported; ++k) {
    const float width = 1000.0F * frame.channels[k] + 1000.0F;
    message.chan_raw[k] = width > 0.0F && width < 65536.0F ? static_cast<std::uint16_t>(width) : 0;
  }
  telemetry_.send(message);
}

void Firmware::handle(const rosflight::Message& message) {
  std::visit(
      [this](const auto& content) {
        using Content = std::decay_t<decltype(content)>;
        if constexpr (std::is_same_v<Content, rosflight::OffboardControl>) {
          mux_.take(content, now_ms());
        } else if constexpr (std::is_same_v<Content, rosflight::Heartbeat>) {
          telemetry_.set_connected();
        } else if constexpr (std::is_same_v<Content, rosflight::RosflightAuxCmd>) {
          mixer_.take(content);
        } else if constexpr (requires { this->on(content); }) {
          on(content);
        }
      },
      message);
}

void Firmware::on(const rosflight::ParamRequestRead& request) {
  if (request.target_system != parameters_.integer(parameter("SYS_ID"))) return;
  const ParameterId id = request.param_index < 0
                             ? find_parameter(rosflight::text_of(request.param_id))
                             : ParameterId{static_cast<std::uint16_t>(request.param_index)};
  if (id.index < kParameterCount) telemetry_.send_parameter(parameters_, id);
}

void Firmware::on(const rosflight::ParamRequestList& request) {
  if (request.target_system == parameters_.integer(parameter("SYS_ID"))) telemetry_.start_parameter_list();
}

void Firmware::on(const rosflight::ParamSet& request) {
  if (request.target_system != parameters_.integer(parameter("SYS_ID"))) return;
  const ParameterId id = find_parameter(rosflight::text_of(request.param_id));
  if (id.index == kParameterCount) return;
  if (static_cast<std::uint8_t>(kParameterTable[id.index].type) != request.param_type) return;
  parameters_.set_bits(id, request.param_value.bits);
}

void Firmware::on(const rosflight::Timesync& request) {
  if (request.tc1 != 0) return;
  telemetry_.send(rosflight::Timesync{.tc1 = static_cast<std::int64_t>(now_us_) * 1000, .ts1 = request.ts1});
}

void Firmware::on(const rosflight::ExternalAttitude& message) {
  filter_.set_external({message.qw, message.qx, message.qy, message.qz});
}

void Firmware::on(const rosflight::RosflightCmd& request) {
  const bool accepted = !arming_.armed() && run_command(request.command);
  telemetry_.send(rosflight::RosflightCmdAck{.command = request.command, .success = accepted});
}

bool Firmware::run_command(std::uint8_t command) {
  switch (command) {
    case rosflight::kCalibrateRc:
      calibrate_trim();
      return true;
    case rosflight::kCalibrateImu:
      start_imu_calibration();
      return true;
    case rosflight::kCalibrateGyro:
      start_gyro_calibration();
      return true;
    case rosflight::kCalibrateBaro:
      baro_calibration_.start();
      return true;
    case rosflight::kCalibrateAirspeed:
      airspeed_calibration_.start();
      return true;
    case rosflight::kReadParameters:
      parameters_.load();
      configure_parts();
      return true;
    case rosflight::kWriteParameters:
      parameters_.save();
      return true;
    case rosflight::kDefaultParameters:
      parameters_.set_defaults();
      configure_parts();
      return true;
    case rosflight::kReboot:
    case rosflight::kRebootToBootloader:
      return true;
    case rosflight::kSendVersion: {
      rosflight::RosflightVersion message{};
      std::copy(kVersion.begin(), kVersion.end(), message.version.begin());
      telemetry_.send(message);
      return true;
    }
  }
  return false;  // unknown, or not supported by this version
}

}  // namespace ironbird::hil_bridge::virtual_fcu
