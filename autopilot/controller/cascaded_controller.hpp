#pragma once

#include "autopilot/controller/cascade.hpp"
#include "autopilot/controller/controller.hpp"
#include "autopilot/controller/flight_phase.hpp"
#include "autopilot/controller/touch_down.hpp"
#include "autopilot/module/tunable.hpp"

namespace ironbird::autopilot {

/// Constants of the cascaded controller: those of the cascade, and how to take off and land.
struct CascadedControllerParams : CascadeParams {
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

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    CascadeParams::describe(self, visit);
    visit("take_off_on_arming", self.take_off_on_arming, "1",
          "arming is the request to take off, once there is something to fly");
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
    visit("touch_down_time", self.touch_down_time, "s", "how long both must last on the ground", 0.1, 10.0);
  }
};

/// The cascade with a flight phase: takes off, holds, flies the follower's setpoint, lands. ROScopter paper,
/// section on the controller.
///
/// The FCU alone can disarm: after touch-down the controller asks for no thrust until the pilot disarms.
/// While the pilot or a failsafe has the vehicle, all integrals are 0 and the point to hold is where the
/// vehicle is. Without a usable estimate nothing is sent, and the FCU's own time-out decides.
class CascadedController final : public Tunable<Controller, CascadedControllerParams> {
 public:
  CascadedController() : cascade_(params()) {}

  void request_take_off() override { take_off_requested_ = true; }
  void request_landing() override { landing_requested_ = true; }
  void reset() override;
  void probe(ProbeVisitor& visit) const override;

 protected:
  void on_parameters() override { cascade_.set_params(params()); }
  FcuCommand control(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                     const FcuStatus& status, double dt, FlightPhase& phase) override;

 private:
  PhaseInputs inputs(const ControlSetpoint& setpoint, bool landing, const StateEstimate& estimate,
                     const FcuStatus& status, FlightPhase phase) const;
  void enter(FlightPhase phase, FlightPhase from, const StateEstimate& estimate);
  ControlSetpoint climb() const;
  ControlSetpoint hold() const;
  ControlSetpoint descend(const StateEstimate& estimate) const;
  FcuCommand land(const StateEstimate& estimate, bool overridden, const Cascade::Step& step);

  Cascade cascade_;
  TouchDown touch_down_;
  bool take_off_requested_ = false;
  bool landing_requested_ = false;
  bool entered_ = false;               // the phase was entered by this object, not taken over
  Vector3 point_N_ = Vector3::Zero();  // to climb over, to hold, to land at
  double point_heading_ = 0.0;
  double ground_down_ = 0.0;  // where the climb began, m down
  Time phase_began_{0};
};

}  // namespace ironbird::autopilot
