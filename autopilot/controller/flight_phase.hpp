#pragma once

#include "autopilot/types/flight_status.hpp"

namespace ironbird::autopilot {

/// What decides the next phase.
struct PhaseInputs {
  bool armed = false;            ///< the FCU says so
  bool estimate_usable = false;  ///< there is an estimate to fly on
  bool take_off_wanted = false;  ///< by request, or by arming
  bool height_reached = false;   ///< near enough to the take-off height
  bool hold_over = false;        ///< the hold after take-off has lasted long enough
  bool setpoint_valid = false;   ///< there is something to fly
  bool route_lands = false;      ///< the trajectory has come to a landing waypoint
  bool landing_wanted = false;   ///< by request
  bool on_ground = false;        ///< touch-down was felt

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("armed", self.armed, "1", "motors may turn");
    visit("estimate_usable", self.estimate_usable, "1", "there is an estimate to fly on");
    visit("take_off_wanted", self.take_off_wanted, "1", "by request, or by arming");
    visit("height_reached", self.height_reached, "1", "near enough to the take-off height");
    visit("hold_over", self.hold_over, "1", "the hold has lasted long enough");
    visit("setpoint_valid", self.setpoint_valid, "1", "there is something to fly");
    visit("route_lands", self.route_lands, "1", "the trajectory has come to a landing waypoint");
    visit("landing_wanted", self.landing_wanted, "1", "by request");
    visit("on_ground", self.on_ground, "1", "touch-down was felt");
  }
};

/// The state machine of the controller: one row per phase and reason. ROScopter paper, section on the
/// controller; landing is ours.
constexpr FlightPhase next_phase(FlightPhase phase, const PhaseInputs& in) {
  if (!in.armed) return FlightPhase::kDisarmed;
  switch (phase) {
    case FlightPhase::kDisarmed:
      return in.take_off_wanted && in.estimate_usable ? FlightPhase::kTakeOff : FlightPhase::kDisarmed;
    case FlightPhase::kTakeOff:
      if (in.landing_wanted) return FlightPhase::kLanding;
      return in.height_reached ? FlightPhase::kHold : FlightPhase::kTakeOff;
    case FlightPhase::kHold:
      if (in.landing_wanted) return FlightPhase::kLanding;
      return in.hold_over && in.setpoint_valid ? FlightPhase::kOffboard : FlightPhase::kHold;
    case FlightPhase::kOffboard:
      if (in.landing_wanted || (in.setpoint_valid && in.route_lands)) return FlightPhase::kLanding;
      return in.setpoint_valid ? FlightPhase::kOffboard : FlightPhase::kHold;
    case FlightPhase::kLanding:
      return in.on_ground && in.take_off_wanted ? FlightPhase::kTakeOff : FlightPhase::kLanding;
  }
  return FlightPhase::kDisarmed;
}

}  // namespace ironbird::autopilot
