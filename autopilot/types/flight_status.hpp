#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "autopilot/types/sensor_frame.hpp"

namespace ironbird::autopilot {

/// The controller's state machine. ROScopter paper, section on the controller; landing is ours.
enum class FlightPhase : std::uint8_t {
  kDisarmed,  ///< motors may not turn
  kTakeOff,   ///< climbing on the spot
  kHold,      ///< holding the point above the take-off place
  kOffboard,  ///< flying the follower's setpoint
  kLanding    ///< descending on the spot until the ground is felt
};

constexpr std::array<std::pair<FlightPhase, std::string_view>, 5> enumerators(FlightPhase) {
  return {{{FlightPhase::kDisarmed, "disarmed"},
           {FlightPhase::kTakeOff, "take_off"},
           {FlightPhase::kHold, "hold"},
           {FlightPhase::kOffboard, "offboard"},
           {FlightPhase::kLanding, "landing"}}};
}

/// Who flies and in which phase: what the FCU said last, and the phase that the controller was in after the
/// previous tick.
struct FlightStatus {
  FlightPhase phase = FlightPhase::kDisarmed;
  FcuStatus fcu;

  /// The follower's setpoints reach the motors: in the offboard phase, armed, and no axis held by the pilot.
  bool companion_flies() const {
    return phase == FlightPhase::kOffboard && fcu.armed && !fcu.failsafe && fcu.rc_override == 0;
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("phase", self.phase, "1", "phase of the controller's state machine");
    visit("fcu", self.fcu, "", "what the FCU said last");
  }
};

}  // namespace ironbird::autopilot
