#pragma once

#include <array>

#include "hil_bridge/interlock/interlock_state.hpp"

// What the interlock looks at, for the tests of this room.

namespace ironbird::hil_bridge::test {

/// Every input.
inline constexpr std::array<bool InterlockInputs::*, 15> kSwitches = {
    &InterlockInputs::link_alive,     &InterlockInputs::unit_known,     &InterlockInputs::unit_disarmed,
    &InterlockInputs::unit_armed,     &InterlockInputs::unit_faultless, &InterlockInputs::parameters_equal,
    &InterlockInputs::sensors_flow,   &InterlockInputs::radio_present,  &InterlockInputs::estimate_usable,
    &InterlockInputs::commands_sound, &InterlockInputs::bench_in_time,  &InterlockInputs::watchdog_awake,
    &InterlockInputs::release_wanted, &InterlockInputs::reset_wanted,   &InterlockInputs::kill_wanted};

/// Everything as it should be before a flight.
inline InterlockInputs sound() {
  InterlockInputs in;
  in.link_alive = in.unit_known = in.unit_disarmed = in.unit_faultless = in.parameters_equal = true;
  in.sensors_flow = in.radio_present = in.estimate_usable = true;
  return in;
}

}  // namespace ironbird::hil_bridge::test
