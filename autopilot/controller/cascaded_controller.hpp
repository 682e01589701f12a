#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "autopilot/controller/cascade.hpp"
#include "autopilot/controller/controller.hpp"
#include "autopilot/controller/descent.hpp"
#include "autopilot/controller/flight_phase.hpp"
#include "autopilot/controller/rest_watch.hpp"
#include "autopilot/controller/touch_down.hpp"
#include "autopilot/controller/upright_watch.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {

/// Constants of the cascaded controller: those of the cascade, what counts as rest, and how to take off and
/// land.
struct CascadedControllerParams : CascadeParams, RestLimits {
  bool take_off_on_arming = false;
  bool take_off_pass_through = true;
  bool zeros_while_disarmed = false;
  double take_off_height = 2.0;
  double take_off_height_threshold = 0.5;
  double take_off_speed = 0.5;
  double take_off_hold_time = 1.0;
  double descent_speed = 1.5;
  double landing_speed = 0.4;
  double landing_slow_height = 3.0;
  double touch_down_speed = 0.15;
  double touch_down_lift = 0.95;
  double touch_down_time = 1.0;
  double arming_patience = 5.0;
  double silence_patience = 2.0;
  double doubt_patience = 10.0;
  double braking_acceleration = 2.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    CascadeParams::describe(self, visit);
    visit("take_off_on_arming", self.take_off_on_arming, "1",
          "arming is the request to take off, when there is something to fly");
    visit("take_off_pass_through", self.take_off_pass_through, "1",
          "take-off, hold and landing ask for torque and thrust; false: for angles and throttle");
    visit("zeros_while_disarmed", self.zeros_while_disarmed, "1",
          "while disarmed zero torque and thrust are sent; false: nothing is sent");
    visit("take_off_height", self.take_off_height, "m", "height to climb to, above where the climb began",
          0.5, 100.0);
    visit("take_off_height_threshold", self.take_off_height_threshold, "m",
          "distance below that height at which the climb ends", 0.05, 10.0);
    visit("take_off_speed", self.take_off_speed, "m/s", "speed of the climb", 0.1, 5.0);
    visit("take_off_hold_time", self.take_off_hold_time, "s", "how long to hold before flying on", 0.0, 60.0);
    visit("descent_speed", self.descent_speed, "m/s", "speed of the descent when high", 0.1, 5.0);
    visit("landing_speed", self.landing_speed, "m/s", "speed of the descent near the ground", 0.1, 2.0);
    visit("landing_slow_height", self.landing_slow_height, "m",
          "height above the take-off place below which the descent is slow", 0.5, 100.0);
    visit("touch_down_speed", self.touch_down_speed, "m/s", "slower than this nothing moves", 0.01, 1.0);
    visit("touch_down_lift", self.touch_down_lift, "1",
          "share of the weight below which the vehicle ought to sink", 0.1, 1.0);
    visit("touch_down_time", self.touch_down_time, "s", "how long both must last on the ground", 0.5, 10.0);
    visit("arming_patience", self.arming_patience, "s",
          "how long after arming it still counts as the request to take off", 0.1, 30.0);
    visit("silence_patience", self.silence_patience, "s",
          "how long it is kept level without an estimate; one that is back by then is landed on", 0.0, 10.0);
    visit("doubt_patience", self.doubt_patience, "s",
          "how long it holds a position that the satellites contradict, before it lands there", 0.0, 600.0);
    visit("braking_acceleration", self.braking_acceleration, "m/s^2",
          "what a vehicle at speed comes to rest with, to hold or to land", 0.1, 20.0);
    RestLimits::describe(self, visit);
  }

  static std::string_view conflict(const CascadedControllerParams& p) {
    if (const std::string_view reason = CascadeParams::conflict(p); !reason.empty()) return reason;
    if (p.touch_down_speed >= std::min(p.landing_speed, p.descent_speed)) {
      return "touch_down_speed must be less than landing_speed and descent_speed";
    }
    if (p.landing_speed > p.max_descent_speed) return "landing_speed must not be above max_descent_speed";
    if (p.take_off_height_threshold >= p.take_off_height) {
      return "take_off_height_threshold must be less than take_off_height";
    }
    return {};
  }

  static std::string_view danger(const CascadedControllerParams& was, const CascadedControllerParams& now) {
    if (const std::string_view reason = CascadeParams::danger(was, now); !reason.empty()) return reason;
    if (now.take_off_pass_through != was.take_off_pass_through) {
      return "take_off_pass_through must stay as it is";
    }
    const bool same_ground = static_cast<const RestLimits&>(now) == static_cast<const RestLimits&>(was) &&
                             now.touch_down_speed == was.touch_down_speed &&
                             now.touch_down_lift == was.touch_down_lift &&
                             now.touch_down_time == was.touch_down_time;
    return same_ground ? ""
                       : "what the ground is felt by (touch_down_, rest_, idle_output) must stay as it is";
  }
};

/// The cascade with a flight phase: takes off, holds, flies the follower's setpoint, lands. ROScopter paper,
/// section on the controller.
///
/// The FCU alone can disarm: after touch-down the controller asks for no thrust until the pilot disarms.
/// While the pilot or a failsafe has the vehicle, all integrals are 0 and the point to hold is where the
/// vehicle would come to rest; when it lies on the ground meanwhile, it needs a new request to take off. With
/// a position in doubt it holds, then lands on the spot; without one it descends level; without a usable
/// estimate it is kept level as far as is known for `silence_patience`, then nothing is sent, and the FCU's
/// own time-out decides.
class CascadedController final : public Tunable<Controller, CascadedControllerParams> {
 public:
  CascadedController() : cascade_(params()) {}

  void reset() override;
  void hand_over(Handover& handover) const override;
  void take_over(const Handover& left) override;
  void probe(ProbeVisitor& visit) const override;

 protected:
  void on_parameters() override { cascade_.set_params(params()); }
  std::string_view refusal(FlightWish wish, const StateEstimate& estimate,
                           const FcuStatus& status) const override;
  FcuCommand control(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                     const FcuStatus& status, double dt, PhaseStep& step) override;

 private:
  PhaseInputs inputs(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                     const FcuStatus& status, FlightPhase phase) const;
  void watch(const StateEstimate& estimate, const FcuStatus& status);
  bool rests_with_pilot(const StateEstimate& estimate) const;
  FcuCommand fly(const ControlSetpoint& setpoint, const StateEstimate& estimate, const FcuStatus& status,
                 double dt, FlightPhase phase);
  FcuCommand stop();
  void note_lift(const FcuCommand& command, const StateEstimate& estimate, const FcuStatus& status,
                 double dt);
  bool take_off_wanted(const ControlSetpoint& setpoint, const StateEstimate& estimate,
                       const FcuStatus& status, FlightPhase phase) const;
  void enter(FlightPhase phase, FlightPhase from, const StateEstimate& estimate);
  FcuCommand without_estimate(const StateEstimate& estimate, bool overridden, double dt);
  ControlSetpoint climb() const;
  Approach hold() const;
  double sink_rate(const StateEstimate& estimate) const;
  FcuCommand land(FlightPhase phase, const StateEstimate& estimate, bool overridden,
                  const Cascade::Step& step);

  Cascade cascade_;
  TouchDown touch_down_;
  bool seen_disarmed_ = false;    // by this object, in the step before
  std::optional<Time> armed_at_;  // none: not armed, or not seen to arm
  RestWatch rest_;
  UprightWatch upright_;
  Descent descent_;
};

}  // namespace ironbird::autopilot
