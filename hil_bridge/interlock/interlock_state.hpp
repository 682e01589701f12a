#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace ironbird::hil_bridge {

// The state machine of the interlock, to be read beside docs/safety.md.

/// How far a unit may be commanded.
enum class InterlockState : std::uint8_t {
  kCold,       ///< no unit, or not one that we know
  kConnected,  ///< link alive both ways, version and dialect known
  kVerified,   ///< parameters are the scenario's, sensors flow, radio present, disarmed, estimate healthy
  kReleased,   ///< an operator has said so
  kLive,       ///< the pilot has armed
  kKilled,     ///< something was wrong
};
inline constexpr std::array kInterlockStates = {InterlockState::kCold,     InterlockState::kConnected,
                                                InterlockState::kVerified, InterlockState::kReleased,
                                                InterlockState::kLive,     InterlockState::kKilled};

std::string_view name_of(InterlockState state);

/// Everything that the interlock looks at, once in every control period.
struct InterlockInputs {
  bool link_alive = false;
  bool unit_known = false;
  bool unit_disarmed = false;
  bool unit_armed = false;
  bool unit_faultless = false;
  bool parameters_equal = false;
  bool sensors_flow = false;
  bool radio_present = false;
  bool estimate_usable = false;
  bool commands_sound = true;
  bool bench_in_time = true;
  bool watchdog_awake = true;
  bool release_wanted = false;
  bool reset_wanted = false;
  bool kill_wanted = false;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("link_alive", self.link_alive, "1", "the line is up and the unit's heartbeat younger than 3 s");
    visit("unit_known", self.unit_known, "1", "it said its version, and its parameters are all known");
    visit("unit_disarmed", self.unit_disarmed, "1", "its latest report, not older than 0.5 s, says disarmed");
    visit("unit_armed", self.unit_armed, "1", "its latest report, not older than 0.5 s, says armed");
    visit("unit_faultless", self.unit_faultless, "1", "no error bit and no failsafe flag");
    visit("parameters_equal", self.parameters_equal, "1", "its parameters are those of the scenario");
    visit("sensors_flow", self.sensors_flow, "1", "its IMU was heard in the last 50 ms");
    visit("radio_present", self.radio_present, "1",
          "radio frames in the last 100 ms, an override switch is mapped");
    visit("estimate_usable", self.estimate_usable, "1", "the autopilot knows attitude and height");
    visit("commands_sound", self.commands_sound, "1", "no refusals for longer than half the unit's time-out");
    visit("bench_in_time", self.bench_in_time, "1", "the control loop keeps its period");
    visit("watchdog_awake", self.watchdog_awake, "1", "the process that guards the bench answers");
    visit("release_wanted", self.release_wanted, "1", "the operator releases the run, now");
    visit("reset_wanted", self.reset_wanted, "1", "the operator resets after a kill, now");
    visit("kill_wanted", self.kill_wanted, "1", "the operator kills, now");
  }
};

/// What keeps a unit from being verified, for the operator: "no radio frames, ..."; empty: nothing.
std::string what_is_missing(const InterlockInputs& in);

/// One row: from these states, if this holds, to that one.
struct InterlockRow {
  std::string_view name;
  std::initializer_list<InterlockState> from;
  InterlockState to;
  bool (*holds)(const InterlockInputs&);
  std::string_view why;  ///< what the operator is told
};

/// The first row that holds, or none: then the state stays.
const InterlockRow* deciding_row(InterlockState state, const InterlockInputs& in);

/// All rows, in the order in which they are tried.
std::span<const InterlockRow> interlock_rows();

}  // namespace ironbird::hil_bridge
