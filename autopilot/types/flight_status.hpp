#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "autopilot/types/sensor_frame.hpp"

namespace ironbird::autopilot {

/// The controller's state machine. ROScopter paper, section on the controller; landing and what follows is
/// ours.
enum class FlightPhase : std::uint8_t {
  kDisarmed,      ///< on the ground, waits for arming and a request to take off: nothing or zeros are sent
  kTakeOff,       ///< climbing on the spot
  kHold,          ///< holding a point
  kOffboard,      ///< flying the follower's setpoint, or the operator's
  kLanding,       ///< descending on the spot until the ground is felt
  kLevelDescent,  ///< descending level, on height and attitude alone, until the ground is felt
  kSilent  ///< no estimate to fly on: in the air level for a moment, then nothing is sent and the FCU decides
};

constexpr std::array<std::pair<FlightPhase, std::string_view>, 7> enumerators(FlightPhase) {
  return {{{FlightPhase::kDisarmed, "disarmed"},
           {FlightPhase::kTakeOff, "take_off"},
           {FlightPhase::kHold, "hold"},
           {FlightPhase::kOffboard, "offboard"},
           {FlightPhase::kLanding, "landing"},
           {FlightPhase::kLevelDescent, "level_descent"},
           {FlightPhase::kSilent, "silent"}}};
}

/// Why the phase changed, when neither operator, pilot nor route asked for it.
enum class PhaseCause : std::uint8_t {
  kPlanned,           ///< somebody asked for it, or it is the next step of what was asked for
  kPositionUnknown,   ///< the horizontal position is no longer known
  kPositionKnown,     ///< it is known again
  kPositionDoubtful,  ///< the satellites contradict it
  kEstimateLost,      ///< not even height and attitude are to be trusted
  kEstimateBack,      ///< they are again, soon enough to land
  kRestsWithPilot     ///< the vehicle came to rest while pilot or failsafe had it
};

constexpr std::array<std::pair<PhaseCause, std::string_view>, 7> enumerators(PhaseCause) {
  return {{{PhaseCause::kPlanned, "planned"},
           {PhaseCause::kPositionUnknown, "position_unknown"},
           {PhaseCause::kPositionKnown, "position_known"},
           {PhaseCause::kPositionDoubtful, "position_doubtful"},
           {PhaseCause::kEstimateLost, "estimate_lost"},
           {PhaseCause::kEstimateBack, "estimate_back"},
           {PhaseCause::kRestsWithPilot, "rests_with_pilot"}}};
}

/// What a flight must not forget when one of its modules is replaced.
struct FlightMemory {
  Time phase_began{};
  bool launched = false;
  Vector3 launch_N = Vector3::Zero();
  double launch_heading = 0.0;
  bool has_point = false;
  Vector3 point_N = Vector3::Zero();
  double point_heading = 0.0;
  bool on_ground = false;
  bool given_up = false;
  bool blind = false;
  bool may_lie = false;
  Time last_sure{};
  double lift = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("phase_began", self.phase_began, "ns", "stamp of the estimate with which the phase began");
    visit("launched", self.launched, "1", "the vehicle has taken off before");
    visit("launch_N", self.launch_N, "m", "where it took off last, from the local origin");
    visit("launch_heading", self.launch_heading, "rad", "its heading there");
    visit("has_point", self.has_point, "1", "there is a point to climb over, to hold, to land at");
    visit("point_N", self.point_N, "m", "that point, from the local origin");
    visit("point_heading", self.point_heading, "rad", "the heading to keep there");
    visit("on_ground", self.on_ground, "1", "touch-down was felt in this descent");
    visit("given_up", self.given_up, "1", "it was out of control, and has been neither disarmed nor righted");
    visit("blind", self.blind, "1", "the estimate was lost in the air, in this phase");
    visit("may_lie", self.may_lie, "1",
          "it was handed back with idling motors, and it is not known yet whether it flies");
    visit("last_sure", self.last_sure, "ns", "stamp of the last estimate whose position was not in doubt");
    visit("lift", self.lift, "1", "share of the weight, as it is configured, that has carried it lately");
  }
};

/// Who flies and in which phase: what the FCU said last, and the phase that the controller was in after the
/// previous tick.
struct FlightStatus {
  FlightPhase phase = FlightPhase::kDisarmed;
  PhaseCause cause = PhaseCause::kPlanned;
  bool operator_setpoint = false;
  FcuStatus fcu;
  FlightMemory memory;

  /// Setpoints reach the motors: in the offboard phase, armed, and no axis held by the pilot.
  bool setpoint_flies() const { return phase == FlightPhase::kOffboard && fcu.armed && !fcu.overridden(); }

  /// The setpoints that do are the follower's.
  bool companion_flies() const { return setpoint_flies() && !operator_setpoint; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("phase", self.phase, "1", "phase of the controller's state machine");
    visit("cause", self.cause, "1", "why it changed last");
    visit("operator_setpoint", self.operator_setpoint, "1",
          "a setpoint of the operator's is in the place of the follower's");
    visit("fcu", self.fcu, "", "what the FCU said last");
    visit("memory", self.memory, "", "what outlives an exchange of modules");
  }
};

}  // namespace ironbird::autopilot
