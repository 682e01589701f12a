#include "scenarios/replay/px4_flight.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <tuple>
#include <utility>

#include "scenarios/config/one_line.hpp"
#include "scenarios/replay/arrivals.hpp"
#include "scenarios/replay/px4_estimate.hpp"
#include "scenarios/replay/px4_imu.hpp"
#include "scenarios/replay/px4_phases.hpp"
#include "scenarios/replay/px4_records.hpp"
#include "scenarios/replay/px4_sensors.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Arrival;
using hil_bridge::Time;
namespace rosflight = hil_bridge::rosflight;

/// What the log tells of itself under this key.
std::string told(const UlogFile& file, const char* key) {
  const auto found = file.information().find(key);
  return found == file.information().end() ? std::string() : on_one_line(found->second);
}

std::string version_text(const std::string& number) {
  const std::uint64_t value = std::strtoull(number.c_str(), nullptr, 10);
  const auto part = [value](unsigned shift) { return std::to_string((value >> shift) & 0xFFU); };
  return part(24) + "." + part(16) + "." + part(8) + ((value & 0xFFU) == 0xFFU ? "" : " (development)");
}

std::string what_flew(const UlogFile& file) {
  const std::string system = told(file, "sys_name");
  const std::string version = told(file, "ver_sw_release");
  const std::string board = told(file, "ver_hw");
  return (system.empty() ? "an autopilot" : system) + (version.empty() ? "" : " " + version_text(version)) +
         (board.empty() ? "" : " on " + board);
}

/// Does the field of any record hold?
template <class Holds>
bool any(const Px4Records& records, const char* field, Holds&& holds) {
  const auto place = records.find(field);
  for (std::size_t k = 0; place && k < records.size(); ++k) {
    if (holds(records.integer(k, place))) return true;
  }
  return false;
}

bool is_simulated(const Px4Log& log) {
  return told(log.file, "ver_hw").find("SITL") != std::string::npos ||
         log.file.parameter("SYS_HITL").value_or(0.0) > 0.0 ||
         any(log.records("vehicle_status"), "hil_state", [](std::int64_t state) { return state > 0; });
}

bool is_fixed_wing(const Px4Log& log) {
  constexpr std::int64_t kFixedWing = 2;
  constexpr double kAirframe = 1.0;  // of MAV_TYPE
  const Px4Records status = log.records("vehicle_status");
  return any(status, "vehicle_type", [](std::int64_t type) { return type == kFixedWing; }) ||
         any(status, "is_rotary_wing", [](std::int64_t rotary) { return rotary == 0; }) ||
         log.file.parameter("MAV_TYPE").value_or(0.0) == kAirframe;
}

// With samples of the IMU only: two of them may be days apart.
std::vector<Arrival> read_status(Px4Log& log, const std::vector<Arrival>& imu) {
  const Px4Records status = log.records("vehicle_status");
  const auto arming = status.find("arming_state");
  if (!arming)
    log.remark("it does not tell when it was armed (topic vehicle_status): it is taken to be disarmed");
  constexpr std::int64_t kArmed = 2;
  std::vector<Arrival> messages;
  std::size_t next = 0;
  bool armed = false;
  Time due{};
  for (const Arrival& sample : imu) {
    if (sample.when < due) continue;
    for (; next < status.size() && status.published(next) <= sample.when; ++next) {
      armed = status.integer(next, arming) == kArmed;
    }
    messages.push_back(
        {sample.when, rosflight::RosflightStatus{.armed = static_cast<std::uint8_t>(armed ? 1 : 0)}});
    due = sample.when + kStatusPeriod;
  }
  return messages;
}

std::vector<Interval> read_airborne(const Px4Log& log) {
  const Px4Records detected = log.records("vehicle_land_detected");
  const auto landed = detected.find("landed");
  std::vector<Interval> airborne;
  std::optional<Time> since;
  for (std::size_t k = 0; landed && k < detected.size(); ++k) {
    const bool in_air = detected.integer(k, landed) == 0;
    const Time when = std::clamp(detected.published(k), Time::zero(), log.end);
    if (in_air && !since) since = when;
    if (!in_air && since) airborne.push_back({*std::exchange(since, std::nullopt), when});
  }
  if (since) airborne.push_back({*since, log.end});
  return airborne;
}

void append(std::vector<Arrival>& all, const std::vector<Arrival>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

MagneticField Px4Flight::field_there() const {
  constexpr double kRadians = std::numbers::pi / 180.0;
  return magnetic_field(first_fix->lat * kRadians, first_fix->lon * kRadians,
                        static_cast<double>(first_fix->height),
                        unix_time ? decimal_year(*unix_time) : newest_epoch());
}

Px4Flight read_px4_flight(const UlogFile& file, const std::string& name, const Px4Choice& choice) {
  Px4Log log(file, name);
  for (std::string& complaint : file.complaints()) log.remark(std::move(complaint));
  Px4Flight px4;
  px4.flight.what = what_flew(file);
  px4.simulated = is_simulated(log);
  if (px4.simulated) log.remark("it is the log of a simulation, not of a flight: its sensors are a model's");
  if (is_fixed_wing(log))
    log.remark(
        "it is the log of a fixed wing; the estimators take no notice of that, and are not meant for it");
  std::vector<Arrival>& messages = px4.flight.messages;
  messages = read_px4_imu(log);
  const std::vector<Arrival> status = read_status(log, messages);
  append(messages, status);
  append(messages, read_px4_gnss(log, choice.gnss_delay, px4));
  append(messages, read_px4_mag(log, choice.mag, px4));
  append(messages, read_px4_baro(log));
  // Of those at one time the IMU's is the last.
  std::stable_sort(messages.begin(), messages.end(), [](const Arrival& one, const Arrival& other) {
    return std::tuple(one.when, is_imu(one)) < std::tuple(other.when, is_imu(other));
  });
  px4.flight.airborne = read_airborne(log);
  px4.flight.phases = read_px4_phases(log);
  if (auto estimate = read_px4_estimate(log)) px4.flight.estimates.push_back(std::move(*estimate));
  px4.flight.end = log.end;
  px4.flight.remarks = std::move(log.remarks);
  return px4;
}

}  // namespace ironbird::scenarios
