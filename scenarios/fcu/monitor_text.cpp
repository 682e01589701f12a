#include "scenarios/fcu/monitor_text.hpp"

#include <algorithm>
#include <initializer_list>
#include <span>

#include "autopilot/math/euler_zyx.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/degrees.hpp"
#include "scenarios/fcu/printed.hpp"
#include "scenarios/fcu/unit_report.hpp"

namespace ironbird::scenarios {

namespace {

using namespace hil_bridge::rosflight;
using hil_bridge::Time;

constexpr Time kShownSilence = std::chrono::milliseconds(500);
constexpr std::size_t kMotorsShown = 8;
constexpr std::size_t kChannelsShown = 8;
constexpr std::uint8_t kErrorSeverity = 3;

/// One line of the screen: a name, what there is to say, and whether it needs attention.
struct Row {
  std::string name;
  std::string text;
  bool attention = false;
};

autopilot::Vector3 angles_of(const AttitudeQuaternion& attitude) {
  const autopilot::Quaternion q_NB(attitude.q1, attitude.q2, attitude.q3, attitude.q4);
  return autopilot::euler_from_quaternion(q_NB.normalized());
}

std::string values(const char* format, std::span<const float> numbers) {
  std::string text;
  for (const float number : numbers)
    text += (text.empty() ? "" : " ") + printed(format, static_cast<double>(number));
  return text;
}
std::string values(const char* format, std::initializer_list<float> numbers) {
  return values(format, std::span(numbers.begin(), numbers.size()));
}

std::string milliseconds_text(Time time) {
  return printed("%.2f ms", 1e-6 * static_cast<double>(time.count()));
}

Row state_row(const Monitored& unit) {
  const auto* status = unit.view.latest<RosflightStatus>();
  if (status == nullptr) return {"state", "not told yet", false};
  const bool bad = status->armed != 0 || status->failsafe != 0 || status->error_code != 0;
  return {"state",
          std::string(status->armed != 0 ? "ARMED" : "disarmed") +
              (status->failsafe != 0 ? "  FAILSAFE" : "") + "  errors: " + error_names(status->error_code),
          bad};
}

Row link_row(const Monitored& unit) {
  const hil_bridge::LinkHealth health = unit.fcu.health(unit.now);
  const hil_bridge::TimeSyncState& time = unit.fcu.connection().time_sync();
  std::string text = printed("%4.0f frames/s  %5.1f kB/s  %.2f %% lost  ", health.frame_rate,
                             1e-3 * health.byte_rate, 100.0 * health.loss) +
                     std::to_string(health.corrupted) + " corrupted  age " + milliseconds_text(health.age);
  if (time.valid)
    text += "  round trip " + milliseconds_text(time.round_trip) + ", least " +
            milliseconds_text(time.least_round_trip);
  return {"link", text, health.loss > 0.01};
}

void add_motion(const Monitored& unit, std::vector<Row>& rows) {
  if (const auto* attitude = unit.view.latest<AttitudeQuaternion>()) {
    const autopilot::Vector3 angles = angles_of(*attitude) * kDegreesPerRadian;
    rows.push_back({"attitude", printed("roll %+7.2f  pitch %+7.2f  yaw %+7.2f deg", angles.x(), angles.y(),
                                        angles.z())});
    rows.push_back(
        {"rates",
         values("%+7.3f", {attitude->rollspeed, attitude->pitchspeed, attitude->yawspeed}) + " rad/s"});
  }
  if (const auto* imu = unit.view.latest<SmallImu>()) {
    rows.push_back({"IMU",
                    printed("%4d /s  ", rate_of<SmallImu>(unit)) +
                        values("%+7.3f", {imu->xacc, imu->yacc, imu->zacc}) + " m/s^2  " +
                        values("%+7.4f", {imu->xgyro, imu->ygyro, imu->zgyro}) + " rad/s" +
                        printed("  %.1f K", static_cast<double>(imu->temperature)),
                    rate_of<SmallImu>(unit) == 0});
  }
}

void add_slow_sensors(const Monitored& unit, std::vector<Row>& rows) {
  if (const auto* mag = unit.view.latest<SmallMag>()) {
    rows.push_back({"compass", printed("%4d /s  ", rate_of<SmallMag>(unit)) +
                                   values("%+.3g", {mag->xmag, mag->ymag, mag->zmag})});
  }
  if (const auto* baro = unit.view.latest<SmallBaro>()) {
    rows.push_back(
        {"barometer", printed("%4d /s  %.2f m  %.1f Pa", rate_of<SmallBaro>(unit),
                              static_cast<double>(baro->altitude), static_cast<double>(baro->pressure))});
  }
  if (const auto* fix = unit.view.latest<RosflightGnss>()) {
    rows.push_back(
        {"satellites", printed("%4d /s  fix %d, %d satellites  %.7f %.7f  %.1f m  within %.2f m",
                               rate_of<RosflightGnss>(unit), fix->fix_type, fix->num_sat, fix->lat, fix->lon,
                               static_cast<double>(fix->height), static_cast<double>(fix->h_acc))});
  }
  if (const auto* air = unit.view.latest<DiffPressure>()) {
    rows.push_back({"airspeed", printed("%4d /s  %.2f m/s", rate_of<DiffPressure>(unit),
                                        static_cast<double>(air->velocity))});
  }
  if (const auto* range = unit.view.latest<SmallRange>()) {
    rows.push_back(
        {"range", printed("%4d /s  %.2f m", rate_of<SmallRange>(unit), static_cast<double>(range->range))});
  }
}

void add_power(const Monitored& unit, std::vector<Row>& rows) {
  if (const auto* outputs = unit.view.latest<RosflightOutputRaw>()) {
    const bool turning = std::any_of(outputs->values.begin(), outputs->values.begin() + kMotorsShown,
                                     [](float value) { return value > 0.0F; });
    rows.push_back({"outputs", values("%.3f", std::span(outputs->values).first<kMotorsShown>()), turning});
  }
  if (const auto* battery = unit.view.latest<RosflightBatteryStatus>()) {
    rows.push_back({"battery", printed("%.2f V  %.2f A", static_cast<double>(battery->battery_voltage),
                                       static_cast<double>(battery->battery_current))});
  }
}

Row radio_row(const Monitored& unit) {
  const auto* rc = unit.view.latest<RcChannels>();
  if (rc == nullptr || !unit.fcu.connection().radio_alive(unit.now)) {
    return {"radio", "no frames: commands would be frozen", true};
  }
  std::string text = printed("%4d /s ", rate_of<RcChannels>(unit));
  for (std::size_t k = 0; k < kChannelsShown; ++k) text += printed(" %4d", rc->chan_raw[k]);
  return {"radio", text};
}

std::vector<Row> rows_of(const Monitored& unit) {
  std::vector<Row> rows{state_row(unit)};
  if (const auto* status = unit.view.latest<RosflightStatus>())
    rows.push_back({"control", override_names(status->rc_override)});
  rows.push_back(link_row(unit));
  add_motion(unit, rows);
  add_slow_sensors(unit, rows);
  add_power(unit, rows);
  rows.push_back(radio_row(unit));
  for (const UnitText& text : unit.view.texts()) {
    rows.push_back({"text", printed("%7.1f s  ", to_seconds(text.when - unit.since)) + text.text,
                    text.severity <= kErrorSeverity});
  }
  return rows;
}

}  // namespace

std::string silence_of(const Monitored& unit) {
  const Time age = unit.fcu.health(unit.now).age;
  const Time silent = age == Time::max() ? unit.now - unit.since : age;
  if (unit.line_up && silent < kShownSilence) return {};
  const std::string since = printed("SILENT for %.1f s", to_seconds(silent));
  return unit.line_up ? since + ": nothing comes from the unit; is it powered?"
                      : since + ": the line is down, and tried again until it is up";
}

std::vector<std::string> monitor_screen(const Monitored& unit, std::size_t columns, bool colour) {
  std::vector<std::string> lines;
  const auto add = [&](std::string text, bool attention) {
    if (columns > 1 && text.size() > columns - 1) text.resize(columns - 1);
    lines.push_back(colour && attention ? "\033[31m" + text + "\033[0m" : text);
  };
  const std::string& version = unit.fcu.connection().version();
  add("ROSflight " + (version.empty() ? std::string("unit") : version) + " at " + unit.line +
          printed("   %.1f s   Ctrl-C ends", to_seconds(unit.now - unit.since)),
      false);
  if (const std::string silence = silence_of(unit); !silence.empty()) add("  " + silence, true);
  for (const Row& row : rows_of(unit)) add(printed("  %-11s", row.name.c_str()) + row.text, row.attention);
  return lines;
}

std::string monitor_line(const Monitored& unit) {
  const std::string when = printed("%8.1f s  ", to_seconds(unit.now - unit.since));
  if (const std::string silence = silence_of(unit); !silence.empty()) return when + silence;
  std::string text = when + state_row(unit).text;
  if (const auto* attitude = unit.view.latest<AttitudeQuaternion>()) {
    const autopilot::Vector3 angles = angles_of(*attitude) * kDegreesPerRadian;
    text += printed("  roll %+.1f pitch %+.1f yaw %+.1f deg", angles.x(), angles.y(), angles.z());
  }
  if (const auto* outputs = unit.view.latest<RosflightOutputRaw>())
    text += "  outputs " + values("%.2f", std::span(outputs->values).first<4>());
  if (const auto* battery = unit.view.latest<RosflightBatteryStatus>())
    text += printed("  %.1f V", static_cast<double>(battery->battery_voltage));
  text += unit.fcu.connection().radio_alive(unit.now) ? "  radio" : "  NO RADIO";
  const hil_bridge::LinkHealth health = unit.fcu.health(unit.now);
  return text +
         printed("  %.0f frames/s, %.2f %% lost, round trip ", health.frame_rate, 100.0 * health.loss) +
         milliseconds_text(health.round_trip);
}

}  // namespace ironbird::scenarios
