#pragma once

#include "autopilot/types/flight_status.hpp"

namespace ironbird::autopilot {

/// What an operator may ask of the flight phase.
enum class FlightWish : std::uint8_t {
  kTakeOff,  ///< climb
  kLand,     ///< descend here
  kResume    ///< end a descent or a silence, hold, and fly on
};

constexpr std::array<std::pair<FlightWish, std::string_view>, 3> enumerators(FlightWish) {
  return {{{FlightWish::kTakeOff, "take_off"}, {FlightWish::kLand, "land"}, {FlightWish::kResume, "resume"}}};
}

/// What decides the next phase.
struct PhaseInputs {
  bool armed = false;              ///< the FCU says so
  bool estimate_usable = false;    ///< height and attitude can be flown on
  bool position_known = true;      ///< so can the horizontal position
  bool position_doubtful = false;  ///< the satellites contradict it
  bool doubt_long = false;         ///< they have for so long in this phase that it lands
  bool take_off_wanted = false;    ///< by request, or by arming
  bool height_reached = false;     ///< near enough to the take-off height
  bool hold_over = false;          ///< the hold after take-off has lasted long enough
  bool setpoint_valid = false;     ///< there is something to fly
  bool route_lands = false;        ///< the trajectory has come to a landing waypoint
  bool landing_wanted = false;     ///< by request
  bool resume_wanted = false;      ///< by request
  bool on_ground = false;          ///< touch-down was felt
  bool rests_with_pilot = false;   ///< it lies still while pilot or failsafe has it
  bool silence_short = false;      ///< it fell silent so recently that it may land by itself

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("armed", self.armed, "1", "motors may turn");
    visit("estimate_usable", self.estimate_usable, "1", "height and attitude can be flown on");
    visit("position_known", self.position_known, "1", "so can the horizontal position");
    visit("position_doubtful", self.position_doubtful, "1", "the satellites contradict it");
    visit("doubt_long", self.doubt_long, "1", "they have for so long in this phase that it lands");
    visit("take_off_wanted", self.take_off_wanted, "1", "by request, or by arming");
    visit("height_reached", self.height_reached, "1", "near enough to the take-off height");
    visit("hold_over", self.hold_over, "1", "the hold has lasted long enough");
    visit("setpoint_valid", self.setpoint_valid, "1", "there is something to fly");
    visit("route_lands", self.route_lands, "1", "the trajectory has come to a landing waypoint");
    visit("landing_wanted", self.landing_wanted, "1", "by request");
    visit("resume_wanted", self.resume_wanted, "1", "by request");
    visit("on_ground", self.on_ground, "1", "touch-down was felt");
    visit("rests_with_pilot", self.rests_with_pilot, "1", "it lies still while pilot or failsafe has it");
    visit("silence_short", self.silence_short, "1", "it fell silent recently enough to land by itself");
  }
};

/// A phase and why it is that one.
struct PhaseStep {
  FlightPhase phase = FlightPhase::kDisarmed;
  PhaseCause cause = PhaseCause::kPlanned;

  bool operator==(const PhaseStep&) const = default;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("phase", self.phase, "1", "the next phase");
    visit("cause", self.cause, "1", "why, when it is another one than before");
  }
};

/// What a wish is measured by.
struct WishConditions {
  FlightPhase phase = FlightPhase::kDisarmed;
  bool armed = false;
  bool failsafe = false;
  bool pilot_holds = false;
  bool estimate_usable = false;
  bool position_known = true;
  bool position_doubtful = false;
  bool on_ground = false;
  bool overturned = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("phase", self.phase, "1", "phase of the controller");
    visit("armed", self.armed, "1", "motors may turn");
    visit("failsafe", self.failsafe, "1", "the FCU flies its failsafe command");
    visit("pilot_holds", self.pilot_holds, "1", "switches or sticks of the pilot hold an axis");
    visit("estimate_usable", self.estimate_usable, "1", "height and attitude can be flown on");
    visit("position_known", self.position_known, "1", "so can the horizontal position");
    visit("position_doubtful", self.position_doubtful, "1", "the satellites contradict it");
    visit("on_ground", self.on_ground, "1", "touch-down was felt");
    visit("overturned", self.overturned, "1", "it lies on its side or back, or was out of control");
  }
};

/// Why a wish cannot be granted now; empty when it can. A wish is granted at the next step or never: a
/// propeller must not start because of something that was asked for minutes ago.
constexpr std::string_view why_not(FlightWish wish, const WishConditions& now) {
  using enum FlightPhase;
  if (!now.armed) return "the vehicle is not armed";
  const bool stands = now.phase == kDisarmed || now.on_ground;
  if (wish != FlightWish::kLand) {
    if (now.failsafe) return "the FCU flies its failsafe";
    if (now.pilot_holds) return "the pilot has the vehicle";
    if (!now.estimate_usable) return "there is no estimate to fly on";
    if (!now.position_known) return "the horizontal position is not known";
  }
  if (wish == FlightWish::kTakeOff) {
    if (!stands) return "it is flying already";
    if (now.overturned) return "it is overturned or was out of control: stand it up and disarm";
    return now.position_doubtful ? "the satellites contradict the position" : "";
  }
  if (stands) return "it is on the ground";
  if (wish == FlightWish::kLand) {
    return now.phase == kSilent && !now.estimate_usable ? "there is no estimate to land on" : "";
  }
  return now.phase == kLanding || now.phase == kLevelDescent || now.phase == kSilent
             ? ""
             : "it is neither descending nor silent";
}

}  // namespace ironbird::autopilot
