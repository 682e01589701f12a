#pragma once

#include <initializer_list>
#include <optional>

#include "autopilot/controller/flight_phase.hpp"

namespace ironbird::autopilot {

// The state machine of the controller, to be read beside its table in docs/equations_control.md, which a test
// compares with this one. Source: ROScopter paper, section on the controller; what does not lead up is ours.

/// Some of the phases.
class PhaseSet {
 public:
  constexpr PhaseSet(std::initializer_list<FlightPhase> phases) {
    for (const FlightPhase phase : phases) bits_ |= bit(phase);
  }
  constexpr bool contains(FlightPhase phase) const { return (bits_ & bit(phase)) != 0; }
  bool operator==(const PhaseSet&) const = default;

 private:
  static constexpr unsigned bit(FlightPhase phase) { return 1U << static_cast<unsigned>(phase); }

  unsigned bits_ = 0;
};

/// One row of the table. It is code, not data that anyone loads or logs, hence no `describe`.
struct PhaseRow {
  std::string_view name;
  PhaseSet from;
  std::optional<FlightPhase> to;  ///< none: it stays, and no later row is looked at
  bool (*holds)(const PhaseInputs&);
  std::string_view when;  ///< what `holds` looks at, in words
  PhaseCause cause = PhaseCause::kPlanned;
};

namespace condition {

constexpr bool disarmed(const PhaseInputs& in) {
  return !in.armed;
}
constexpr bool rests(const PhaseInputs& in) {
  return in.rests_with_pilot;
}
constexpr bool on_ground(const PhaseInputs& in) {
  return in.on_ground;
}
constexpr bool no_estimate(const PhaseInputs& in) {
  return !in.estimate_usable;
}
constexpr bool position(const PhaseInputs& in) {
  return in.position_known;
}
constexpr bool no_position(const PhaseInputs& in) {
  return !in.position_known;
}
constexpr bool may_fly(const PhaseInputs& in) {
  return in.estimate_usable && in.position_known;
}
constexpr bool in_doubt(const PhaseInputs& in) {
  return in.position_doubtful;
}
constexpr bool long_in_doubt(const PhaseInputs& in) {
  return in.position_doubtful && in.doubt_long;
}
constexpr bool take_off(const PhaseInputs& in) {
  return in.take_off_wanted && may_fly(in) && !in_doubt(in);
}
constexpr bool take_off_again(const PhaseInputs& in) {
  return on_ground(in) && take_off(in);
}
constexpr bool land(const PhaseInputs& in) {
  return in.landing_wanted;
}
constexpr bool land_or_route(const PhaseInputs& in) {
  return land(in) || (in.setpoint_valid && in.route_lands);
}
constexpr bool resume(const PhaseInputs& in) {
  return in.resume_wanted;
}
constexpr bool resume_position(const PhaseInputs& in) {
  return resume(in) && position(in);
}
constexpr bool resume_may_fly(const PhaseInputs& in) {
  return resume(in) && may_fly(in);
}
constexpr bool estimate_back(const PhaseInputs& in) {
  return in.estimate_usable && (in.silence_short || in.landing_wanted);
}
constexpr bool all_back(const PhaseInputs& in) {
  return estimate_back(in) && position(in);
}
constexpr bool height_reached(const PhaseInputs& in) {
  return in.height_reached;
}
constexpr bool hold_over(const PhaseInputs& in) {
  return in.hold_over && in.setpoint_valid && !in_doubt(in);
}
constexpr bool nothing_to_fly(const PhaseInputs& in) {
  return !in.setpoint_valid;
}

}  // namespace condition

namespace phase_table {

using enum FlightPhase;
using enum PhaseCause;
using namespace condition;

inline constexpr PhaseSet kAny{kDisarmed, kTakeOff, kHold, kOffboard, kLanding, kLevelDescent, kSilent};
inline constexpr PhaseSet kAnyButDisarmed{kTakeOff, kHold, kOffboard, kLanding, kLevelDescent, kSilent};
inline constexpr PhaseSet kWithEstimate{kTakeOff, kHold, kOffboard, kLanding, kLevelDescent};
inline constexpr PhaseSet kWithPosition{kTakeOff, kHold, kOffboard, kLanding};
inline constexpr PhaseSet kDescents{kLanding, kLevelDescent};

inline constexpr std::array kRows = std::to_array<PhaseRow>({
    {"disarms", kAny, kDisarmed, disarmed, "the FCU is disarmed"},
    {"takes off",
     {kDisarmed},
     kTakeOff,
     take_off,
     "a take-off is wanted, with estimate and position, not in doubt"},
    {"rests", kAnyButDisarmed, kDisarmed, rests, "it lay still while pilot or failsafe had it",
     kRestsWithPilot},
    {"takes off again", kDescents, kTakeOff, take_off_again,
     "a take-off is wanted on the ground, with estimate and position, not in doubt"},
    {"stays down", kDescents, {}, on_ground, "touch-down was felt"},
    {"resumes after silence",
     {kSilent},
     kHold,
     resume_may_fly,
     "resuming is wanted, with estimate and position"},
    {"lands after silence",
     {kSilent},
     kLanding,
     all_back,
     "the estimate is back with a position, within `silence_patience` or a landing is wanted",
     kEstimateBack},
    {"sinks after silence",
     {kSilent},
     kLevelDescent,
     estimate_back,
     "the estimate is back, within `silence_patience` or a landing is wanted",
     kEstimateBack},
    {"falls silent", kWithEstimate, kSilent, no_estimate, "there is no usable estimate", kEstimateLost},
    {"resumes with position",
     {kLevelDescent},
     kHold,
     resume_position,
     "the position is known again and resuming is wanted",
     kPositionKnown},
    {"lands with position",
     {kLevelDescent},
     kLanding,
     position,
     "the position is known again",
     kPositionKnown},
    {"loses position", kWithPosition, kLevelDescent, no_position, "the horizontal position is not known",
     kPositionUnknown},
    {"lands from climb", {kTakeOff}, kLanding, land, "a landing is wanted"},
    {"has climbed", {kTakeOff}, kHold, height_reached, "within `take_off_height_threshold` of the height"},
    {"lands from hold", {kHold}, kLanding, land, "a landing is wanted"},
    {"lands in doubt",
     {kHold},
     kLanding,
     long_in_doubt,
     "the position has been in doubt for `doubt_patience`",
     kPositionDoubtful},
    {"flies",
     {kHold},
     kOffboard,
     hold_over,
     "`take_off_hold_time` is over, there is something to fly and no doubt about the position"},
    {"lands from route",
     {kOffboard},
     kLanding,
     land_or_route,
     "a landing is wanted, or the route has come to a landing waypoint"},
    {"holds in doubt", {kOffboard}, kHold, in_doubt, "the position is in doubt", kPositionDoubtful},
    {"holds", {kOffboard}, kHold, nothing_to_fly, "there is nothing to fly"},
    {"resumes", {kLanding}, kHold, resume, "resuming is wanted"},
});

}  // namespace phase_table

/// The first row that holds, or none: then the phase stays.
constexpr const PhaseRow* deciding_row(FlightPhase phase, const PhaseInputs& in) {
  for (const PhaseRow& row : phase_table::kRows) {
    if (row.from.contains(phase) && row.holds(in)) return &row;
  }
  return nullptr;
}

/// The phase that follows, and why.
constexpr PhaseStep next_phase(FlightPhase phase, const PhaseInputs& in) {
  const PhaseRow* const row = deciding_row(phase, in);
  return row == nullptr ? PhaseStep{phase, {}} : PhaseStep{row->to.value_or(phase), row->cause};
}

}  // namespace ironbird::autopilot
