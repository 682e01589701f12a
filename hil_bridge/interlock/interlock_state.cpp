#include "hil_bridge/interlock/interlock_state.hpp"

#include <algorithm>

namespace ironbird::hil_bridge {

namespace {

using enum InterlockState;
using In = InterlockInputs;

bool connected(const In& in) {
  return in.link_alive && in.unit_known;
}
bool verified(const In& in) {
  return connected(in) && in.unit_disarmed && !in.unit_armed && in.unit_faultless && in.parameters_equal &&
         in.sensors_flow && in.radio_present && in.estimate_usable && in.commands_sound && in.bench_in_time &&
         in.watchdog_awake;
}

/// What is said where an input does not hold.
struct Missing {
  bool InterlockInputs::*input;
  std::string_view text;
};
constexpr Missing kMissing[] = {
    {&In::link_alive, "no heartbeat of the unit"},
    {&In::unit_known, "its version and parameters are not known yet"},
    {&In::parameters_equal, "its parameters are not the scenario's"},
    {&In::unit_disarmed, "it does not say that it is disarmed"},
    {&In::unit_faultless, "it reports an error or its failsafe"},
    {&In::sensors_flow, "no IMU data"},
    {&In::radio_present, "no radio frames, or no override switch is mapped"},
    {&In::estimate_usable, "no estimate of attitude and height yet"},
    {&In::bench_in_time, "the control loop misses its period"},
    {&In::watchdog_awake, "the watchdog does not answer"},
};

// Kills come first, and among them what the operator wants. A released or flying unit that is not all right
// is killed; one that is not released yet falls back to the state whose conditions hold.
constexpr InterlockRow kRows[] = {
    {"is killed",
     {kCold, kConnected, kVerified, kReleased, kLive},
     kKilled,
     [](const In& in) { return in.kill_wanted; },
     "the operator killed"},
    {"begins anew",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.unit_known; },
     "the unit began anew: it booted, its line was cut, or another one speaks"},
    {"loses the link",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.link_alive; },
     "the unit is not heard any more"},
    {"loses the sensors",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.sensors_flow; },
     "no IMU data for 50 ms"},
    {"loses the radio",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.radio_present; },
     "no radio frames for 100 ms"},
    {"has other parameters",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.parameters_equal; },
     "a parameter of the unit has changed"},
    {"commands nonsense",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.commands_sound; },
     "commands were refused for too long"},
    {"is late",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.bench_in_time; },
     "the control loop misses its period"},
    {"loses its watchdog",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return !in.watchdog_awake; },
     "the watchdog does not answer"},
    {"is at fault",
     {kReleased},
     kKilled,
     [](const In& in) { return !in.unit_faultless; },
     "the unit reports an error"},
    {"loses the estimate",
     {kReleased},
     kKilled,
     [](const In& in) { return !in.estimate_usable; },
     "the autopilot does not know attitude and height"},
    {"reports nothing",
     {kReleased, kLive},
     kKilled,
     [](const In& in) { return in.unit_armed == in.unit_disarmed; },
     "the unit does not say whether it is armed"},
    {"is reset",
     {kKilled},
     kCold,
     [](const In& in) { return in.reset_wanted && !in.kill_wanted && in.unit_disarmed && !in.unit_armed; },
     "the operator reset it, with the unit disarmed"},
    {"connects", {kCold}, kConnected, connected, "version and parameters are known"},
    {"disconnects",
     {kConnected, kVerified},
     kCold,
     [](const In& in) { return !connected(in); },
     "the unit is not heard any more"},
    {"is found sound", {kConnected}, kVerified, verified, "everything is as the scenario wants it"},
    {"is not sound",
     {kVerified},
     kConnected,
     [](const In& in) { return !verified(in); },
     "something is not as the scenario wants it"},
    {"is released",
     {kVerified},
     kReleased,
     [](const In& in) { return in.release_wanted; },
     "the operator released the run"},
    {"goes live", {kReleased}, kLive, [](const In& in) { return in.unit_armed; }, "the pilot armed"},
    {"is done", {kLive}, kVerified, [](const In& in) { return in.unit_disarmed; }, "the pilot disarmed"},
};

}  // namespace

std::string_view name_of(InterlockState state) {
  constexpr std::array<std::string_view, kInterlockStates.size()> kNames = {
      "cold", "connected", "verified", "released", "live", "killed"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string what_is_missing(const InterlockInputs& in) {
  std::string all;
  for (const Missing& missing : kMissing) {
    if (!(in.*missing.input)) all += (all.empty() ? "" : ", ") + std::string(missing.text);
  }
  return all;
}

std::span<const InterlockRow> interlock_rows() {
  return kRows;
}

const InterlockRow* deciding_row(InterlockState state, const InterlockInputs& in) {
  for (const InterlockRow& row : kRows) {
    if (std::find(row.from.begin(), row.from.end(), state) != row.from.end() && row.holds(in)) return &row;
  }
  return nullptr;
}

}  // namespace ironbird::hil_bridge
