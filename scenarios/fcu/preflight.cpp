#include "scenarios/fcu/preflight.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "hil_bridge/executive/unit_watch.hpp"
#include "scenarios/fcu/printed.hpp"
#include "scenarios/fcu/unit_report.hpp"

namespace ironbird::scenarios {

namespace {

using namespace hil_bridge::rosflight;
using hil_bridge::InterlockInputs;
using hil_bridge::ParameterDifference;
using hil_bridge::Time;

constexpr double kGravity = 9.80665;       // m/s^2
constexpr double kGravityTolerance = 0.5;  // m/s^2
constexpr double kStillRate = 0.05;        // rad/s
constexpr double kOfNominalRate = 0.9;
constexpr int kLeastCompassRate = 40;  // Hz; boards sample at 50 and more
constexpr int kLeastBaroRate = 40;     // Hz
constexpr int kLeastFixRate = 4;       // Hz
constexpr int kThreeDimensional = 3;   // fix_type
constexpr int kTimeOnly = 5;           // fix_type
constexpr int kLeastSatellites = 6;
constexpr double kLeastOfFullBattery = 0.85;  // 3.6 V of a cell that is full at 4.2 V
constexpr double kMostOfFullBattery = 1.05;
constexpr int kLeastTimeout = 50;             // ms
constexpr int kGreatestTimeout = 150;         // ms
constexpr std::uint64_t kLeastExchanges = 3;  // that are believed; slow ones are not
constexpr Time kGreatestRoundTrip = std::chrono::milliseconds(20);
constexpr double kGreatestLoss = 0.01;
constexpr double kUnitLengthTolerance = 0.01;
constexpr std::size_t kDifferencesShown = 3;

/// The interlock's own words for one of its inputs.
std::string words_of(std::string_view input) {
  std::string words;
  const InterlockInputs in;
  InterlockInputs::describe(in, [&](const char* name, const auto&, const char*, const char* meaning) {
    if (name == input) words = meaning;
  });
  return words;
}

int whole(const Monitored& unit, std::string_view name, int otherwise) {
  const auto record = unit.fcu.connection().parameters().find(name);
  return record ? std::bit_cast<std::int32_t>(record->bits) : otherwise;
}

double real(const Monitored& unit, std::string_view name) {
  const auto record = unit.fcu.connection().parameters().find(name);
  return record ? static_cast<double>(std::bit_cast<float>(record->bits)) : std::nan("");
}

/// Of the wanted ones those that the unit has otherwise.
std::vector<ParameterDifference> different(const Monitored& unit, const PreflightWishes& wishes) {
  if (!wishes.parameters) return {};
  return hil_bridge::not_as_wanted(*wishes.parameters, unit.fcu.connection().parameters().known());
}

/// The list while it grows.
class List {
 public:
  void add(const char* name, bool green, const std::string& good, const std::string& bad) {
    items.push_back({name, green ? Light::kGreen : Light::kRed, green ? good : bad});
  }
  std::vector<PreflightItem> items;
};

void look_at_link(const Monitored& unit, const InterlockInputs& in, List& list) {
  const hil_bridge::LinkHealth health = unit.fcu.health(unit.now);
  list.add("link", in.link_alive, words_of("link_alive"),
           "not so: " + words_of("link_alive") + "; look at cable and power");
  const std::string rate = printed("%.0f frames/s, %.2f %% lost, %llu corrupted, ", health.frame_rate,
                                   100.0 * health.loss, static_cast<unsigned long long>(health.corrupted));
  list.add("loss", health.loss <= kGreatestLoss && health.unsent == 0, rate + "at most 1 % may be lost",
           rate + "at most 1 % may be lost; look at cable, plug and baud rate");
  const hil_bridge::TimeSyncState& time = unit.fcu.connection().time_sync();
  const std::string trips =
      std::to_string(time.used) + printed(" exchanges believed, least round trip %.2f ms",
                                          1e-6 * static_cast<double>(time.least_round_trip.count()));
  list.add("time", time.valid && time.used >= kLeastExchanges && time.least_round_trip <= kGreatestRoundTrip,
           trips,
           trips +
               "; needs three, the least of at most 20 ms: is the line slow, or a USB converter's latency "
               "timer at 16 ms?");
}

void look_at_identity(const Monitored& unit, const InterlockInputs& in, const PreflightWishes& wishes,
                      List& list) {
  const auto* heartbeat = unit.view.latest<Heartbeat>();
  const int dialect = heartbeat == nullptr ? -1 : heartbeat->mavlink_version;
  const std::string& version = unit.fcu.connection().version();
  const std::string who = (version.empty() ? std::string("version not told") : version) + ", dialect " +
                          std::to_string(dialect) + ", " +
                          std::to_string(unit.fcu.connection().parameters().progress().known) + " parameters";
  const std::string& refusal = unit.fcu.connection().refusal();
  list.add("version", in.unit_known && dialect == kDialectVersion, who,
           who + "; " +
               (refusal.empty()
                    ? "a unit tells its version only while it is disarmed, and must be of ROSflight 2.0"
                    : refusal));
  if (!wishes.parameters) {
    list.items.push_back({"parameters", Light::kUnlit, "not compared: no scenario was named"});
    return;
  }
  const std::vector<ParameterDifference> found = different(unit, wishes);
  const std::string count = std::to_string(wishes.parameters->size());
  std::string bad = std::to_string(found.size()) + " of " + count + " are not the scenario's: ";
  for (std::size_t k = 0; k < std::min(found.size(), kDifferencesShown); ++k) {
    bad += (k == 0 ? "" : ", ") + found[k].name + " is " +
           (found[k].other ? hil_bridge::value_text(*found[k].other) : "missing") + ", wanted " +
           hil_bridge::value_text(*found[k].one);
  }
  bad += found.size() > kDifferencesShown ? ", ...; " : "; ";
  list.add("parameters", in.parameters_equal, "all " + count + " of the scenario are the unit's",
           bad + "push them: ironbird fcu params load " + wishes.scenario);
}

void look_at_inertial(const Monitored& unit, const InterlockInputs& in, const PreflightWishes& wishes,
                      List& list) {
  const int rate = rate_of<SmallImu>(unit);
  const std::string came = std::to_string(rate) + printed(" samples/s of %.0f", wishes.imu_rate);
  list.add("IMU", in.sensors_flow && rate >= kOfNominalRate * wishes.imu_rate, came,
           came + "; needs nine tenths, and that " + words_of("sensors_flow"));
  const auto* imu = unit.view.latest<SmallImu>();
  const auto* status = unit.view.latest<RosflightStatus>();
  if (imu == nullptr || status == nullptr)
    return list.add("calibration", false, "", "nothing is known of it");
  const double force = std::hypot(imu->xacc, imu->yacc, imu->zacc);
  const double turn = std::hypot(imu->xgyro, imu->ygyro, imu->zgyro);
  const bool calibrated = (status->error_code & kUncalibratedImu) == 0;
  const std::string measured = printed("at rest %.2f m/s^2 and %.3f rad/s", force, turn);
  list.add("calibration", calibrated && std::abs(force - kGravity) < kGravityTolerance && turn < kStillRate,
           measured,
           (calibrated ? measured + ", should be 9.81 and 0; does it stand still? Else"
                       : "the unit says that its IMU is not calibrated;") +
               std::string(" calibrate: ironbird fcu calibrate imu --keep"));
}

void look_at_slow_sensors(const Monitored& unit, List& list) {
  const int compass = rate_of<SmallMag>(unit);
  list.add("compass", compass >= kLeastCompassRate, std::to_string(compass) + " samples/s",
           std::to_string(compass) + " samples/s, needs 40");
  const int baro = rate_of<SmallBaro>(unit);
  list.add("barometer", baro >= kLeastBaroRate, std::to_string(baro) + " samples/s",
           std::to_string(baro) + " samples/s, needs 40");
  const int fixes = rate_of<RosflightGnss>(unit);
  const auto* fix = unit.view.latest<RosflightGnss>();
  const int type = fix == nullptr ? 0 : fix->fix_type;
  const int satellites = fix == nullptr ? 0 : fix->num_sat;
  const std::string text = std::to_string(fixes) + " fixes/s of kind " + std::to_string(type) + " with " +
                           std::to_string(satellites) + " satellites";
  list.add("satellites",
           fixes >= kLeastFixRate && type >= kThreeDimensional && type != kTimeOnly &&
               satellites >= kLeastSatellites,
           text, text + "; needs 4/s, a fix in three dimensions and 6 satellites: see the sky, and wait");
}

void look_at_radio(const Monitored& unit, const InterlockInputs& in, List& list) {
  const std::string frames = std::to_string(rate_of<RcChannels>(unit)) + " frames/s";
  const bool mapped = hil_bridge::override_mapped(unit.fcu.connection().parameters());
  list.add(
      "radio", in.radio_present, frames + ", the override switches have channels",
      frames + (mapped ? "; switch the transmitter on"
                       : "; map RC_ATT_OVRD_CHN and RC_THR_OVRD_CHN to channels from 4 to RC_NUM_CHN - 1"));
  const int channel = whole(unit, "RC_F_CHN", -1);
  const auto* rc = unit.view.latest<RcChannels>();
  const bool known = rc != nullptr && channel >= 0 && channel < static_cast<int>(rc->chan_raw.size());
  const double stick =
      known ? 1e-3 * (rc->chan_raw[static_cast<std::size_t>(channel)] - 1000.0) : std::nan("");
  const double limit = real(unit, "RC_ARM_THRESHOLD");
  list.add("throttle", rate_of<RcChannels>(unit) > 0 && stick < limit,
           printed("the stick is at %.0f %%", 100.0 * stick),
           known ? printed("the stick is at %.0f %%, must be below %.0f %%: pull it down", 100.0 * stick,
                           100.0 * limit)
                 : std::string("its stick is not heard"));
}

void look_at_state(const Monitored& unit, const InterlockInputs& in, List& list) {
  list.add("disarmed", in.unit_disarmed && !in.unit_armed, words_of("unit_disarmed"),
           in.unit_armed ? "the unit is ARMED: disarm it by radio" : "not so: " + words_of("unit_disarmed"));
  const auto* status = unit.view.latest<RosflightStatus>();
  list.add("faults", in.unit_faultless, words_of("unit_faultless"),
           status == nullptr
               ? std::string("nothing is known of them")
               : error_names(status->error_code) + (status->failsafe != 0 ? ", and the failsafe flag" : ""));
}

/// A unit whose filter has failed goes on without an error bit: only a reboot, or an IMU calibration, helps.
void look_at_attitude(const Monitored& unit, List& list) {
  const auto* told = unit.view.latest<AttitudeQuaternion>();
  const double norm = told == nullptr
                          ? std::nan("")
                          : std::hypot(std::hypot(told->q1, told->q2), std::hypot(told->q3, told->q4));
  const std::string text =
      told == nullptr ? std::string("not heard") : printed("a quaternion of length %.3f", norm);
  list.add("attitude", std::abs(norm - 1.0) < kUnitLengthTolerance, text,
           text + "; must be 1: reboot the unit, or calibrate its IMU, level and still");
}

void look_at_power(const Monitored& unit, List& list) {
  const double full = real(unit, "BATT_VOLT_MAX");
  const auto* battery = unit.view.latest<RosflightBatteryStatus>();
  const double voltage = battery == nullptr ? 0.0 : static_cast<double>(battery->battery_voltage);
  const std::string text = printed("%.2f V of %.2f V", voltage, full);
  list.add("battery", voltage >= kLeastOfFullBattery * full && voltage <= kMostOfFullBattery * full, text,
           text + "; needs 85 to 105 %: charge it, or set BATT_VOLT_MAX and BATT_VOLT_MULT");
}

void look_at_failsafe(const Monitored& unit, List& list) {
  const double throttle = real(unit, "FAILSAFE_THR");
  const int timeout = whole(unit, "OFFBOARD_TIMEOUT", -1);
  const double idle = real(unit, "MOTOR_IDLE_THR");
  const std::string text =
      printed("FAILSAFE_THR %.2f, OFFBOARD_TIMEOUT %d ms, MOTOR_IDLE_THR %.2f", throttle, timeout, idle);
  const bool sensible = throttle >= 0.0 && throttle <= 1.0 && timeout >= kLeastTimeout &&
                        timeout <= kGreatestTimeout && idle >= 0.0 && idle < 0.5;
  list.add("failsafe", sensible, text, text + "; must be within 0..1, 50..150 ms, 0..0.5");
}

}  // namespace

InterlockInputs interlock_inputs(const Monitored& unit, const PreflightWishes& wishes) {
  const hil_bridge::Connection& connection = unit.fcu.connection();
  InterlockInputs in;
  hil_bridge::report_presence(connection, unit.now, in);
  in.link_alive = in.link_alive && unit.line_up;
  in.unit_known = connection.state() == hil_bridge::ConnectionState::kReady;
  in.parameters_equal = connection.parameters().progress().complete && different(unit, wishes).empty();
  in.radio_present = in.radio_present && hil_bridge::override_mapped(unit.fcu.connection().parameters());
  return in;
}

std::vector<PreflightItem> preflight(const Monitored& unit, const PreflightWishes& wishes) {
  const InterlockInputs in = interlock_inputs(unit, wishes);
  List list;
  look_at_link(unit, in, list);
  look_at_identity(unit, in, wishes, list);
  look_at_inertial(unit, in, wishes, list);
  look_at_attitude(unit, list);
  look_at_slow_sensors(unit, list);
  look_at_radio(unit, in, list);
  look_at_state(unit, in, list);
  look_at_power(unit, list);
  look_at_failsafe(unit, list);
  return list.items;
}

bool all_green(const std::vector<PreflightItem>& items) {
  return std::none_of(items.begin(), items.end(),
                      [](const PreflightItem& item) { return item.light == Light::kRed; });
}

std::string preflight_text(const std::vector<PreflightItem>& items, bool colour) {
  std::string text;
  for (const PreflightItem& item : items) {
    const char* const word = item.light == Light::kGreen ? "ok" : item.light == Light::kRed ? "NO" : "-";
    const char* const paint = item.light == Light::kGreen ? "\033[32m"
                              : item.light == Light::kRed ? "\033[31m"
                                                          : "";
    const std::string head = printed("%-4s", word);
    text += "  " + (colour ? paint + head + "\033[0m" : head) + printed("%-13s", item.name.c_str()) +
            item.reason + "\n";
  }
  return text + (all_green(items) ? "ready\n" : "not ready\n");
}

std::string preflight_json(const std::vector<PreflightItem>& items) {
  nlohmann::ordered_json json;
  json["ready"] = all_green(items);
  for (const PreflightItem& item : items) {
    const char* const light = item.light == Light::kGreen ? "green"
                              : item.light == Light::kRed ? "red"
                                                          : "unlit";
    json["items"].push_back({{"name", item.name}, {"light", light}, {"reason", item.reason}});
  }
  return json.dump(2) + "\n";
}

}  // namespace ironbird::scenarios
