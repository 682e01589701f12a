#include "scenarios/fcu/unit_report.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

template <std::size_t N>
std::string names_of(unsigned bits, const std::array<std::pair<unsigned, const char*>, N>& names,
                     const char* none) {
  std::string text;
  for (const auto& [bit, name] : names) {
    if ((bits & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text.empty() ? none : text;
}

double milliseconds(Time time) {
  return 1e-6 * static_cast<double>(time.count());
}

std::string number(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string fact(const char* name, const std::string& value) {
  std::string line = "  ";
  line += name;
  line.resize(18, ' ');
  return line + value + "\n";
}

}  // namespace

std::string error_names(std::uint8_t code) {
  using enum hil_bridge::rosflight::ErrorBit;
  constexpr std::array<std::pair<unsigned, const char*>, 8> kNames = {
      {{kInvalidMixer, "invalid mixer"},
       {kImuNotResponding, "IMU not responding"},
       {kErrorRcLost, "radio lost"},
       {kUnhealthyEstimator, "unhealthy estimator"},
       {kTimeGoingBackwards, "time going backwards"},
       {kUncalibratedImu, "uncalibrated IMU"},
       {kBufferOverrun, "buffer overrun"},
       {kInvalidFailsafe, "invalid failsafe throttle"}}};
  return names_of(code, kNames, "none");
}

std::string override_names(std::uint16_t bits) {
  using enum hil_bridge::rosflight::OverrideBit;
  constexpr std::array<std::pair<unsigned, const char*>, 10> kNames = {
      {{kAttitudeSwitch, "attitude switch"},
       {kThrottleSwitch, "throttle switch"},
       {kRollStick, "roll stick"},
       {kPitchStick, "pitch stick"},
       {kYawStick, "yaw stick"},
       {kMinimumThrottle, "throttle stick below the companion"},
       {kRollInactive, "no roll from the companion"},
       {kPitchInactive, "no pitch from the companion"},
       {kYawInactive, "no yaw from the companion"},
       {kThrottleInactive, "no throttle from the companion"}}};
  return names_of(bits, kNames, "the companion has all");
}

std::string unit_report(const hil_bridge::SerialFcu& fcu, const std::string& line, Time now) {
  const hil_bridge::Connection& connection = fcu.connection();
  const hil_bridge::LinkHealth health = fcu.health(now);
  const hil_bridge::TimeSyncState& time = connection.time_sync();
  std::string text = "ROSflight unit at " + line + "\n";
  text += fact("firmware", connection.version().empty() ? "(not told while armed)" : connection.version());
  text += fact("parameters", std::to_string(connection.parameters().progress().known) + " of " +
                                 std::to_string(connection.parameters().progress().count));
  if (const auto& status = connection.status()) {
    text += fact("armed", status->armed != 0 ? "YES" : "no");
    text += fact("failsafe", status->failsafe != 0 ? "YES" : "no");
    text += fact("errors", error_names(status->error_code));
    text += fact("control", override_names(status->rc_override));
    text += fact("loop time", std::to_string(status->loop_time_us) + " us");
  }
  text += fact("radio", connection.radio_alive(now) ? "frames come" : "no frames: commands would be frozen");
  text += fact("IMU", connection.imu_alive(now) ? "samples come" : "silent");
  text += fact("link", number("%.0f frames/s, ", health.frame_rate) +
                           number("%.1f kB/s, ", 1e-3 * health.byte_rate) +
                           number("%.2f %% lost, ", 100.0 * health.loss) + std::to_string(health.corrupted) +
                           " corrupted");
  text += fact("round trip", number("%.3f ms, ", milliseconds(time.round_trip)) +
                                 number("least %.3f ms", milliseconds(time.least_round_trip)));
  text += fact("clock", number("drift %+.1f ppm", 1e6 * time.drift));
  text += "  messages a second\n";
  for (std::size_t k = 0; k < hil_bridge::rosflight::kDialect.size(); ++k) {
    const int rate = fcu.statistics().rate(k);
    if (rate == 0) continue;
    std::string name = "    " + std::string(hil_bridge::rosflight::kDialect[k].name);
    name.resize(32, ' ');
    text += name + std::to_string(rate) + "\n";
  }
  return text;
}

std::string unit_report_json(const hil_bridge::SerialFcu& fcu, const std::string& line, Time now) {
  const hil_bridge::Connection& connection = fcu.connection();
  const hil_bridge::LinkHealth health = fcu.health(now);
  nlohmann::ordered_json json;
  json["line"] = line;
  json["firmware"] = connection.version();
  json["parameters"] = connection.parameters().progress().known;
  if (const auto& status = connection.status()) {
    json["armed"] = status->armed != 0;
    json["failsafe"] = status->failsafe != 0;
    json["error_code"] = status->error_code;
    json["rc_override"] = status->rc_override;
    json["loop_time_us"] = status->loop_time_us;
  }
  json["radio"] = connection.radio_alive(now);
  json["imu"] = connection.imu_alive(now);
  json["frames_per_second"] = health.frame_rate;
  json["bytes_per_second"] = health.byte_rate;
  json["loss"] = health.loss;
  json["corrupted"] = health.corrupted;
  json["round_trip_ms"] = milliseconds(connection.time_sync().round_trip);
  json["least_round_trip_ms"] = milliseconds(connection.time_sync().least_round_trip);
  json["drift_ppm"] = 1e6 * connection.time_sync().drift;
  nlohmann::ordered_json rates;
  for (std::size_t k = 0; k < hil_bridge::rosflight::kDialect.size(); ++k) {
    if (fcu.statistics().rate(k) > 0)
      rates[std::string(hil_bridge::rosflight::kDialect[k].name)] = fcu.statistics().rate(k);
  }
  json["rates"] = rates;
  return json.dump(2) + "\n";
}

}  // namespace ironbird::scenarios
