#pragma once

#include <gtest/gtest.h>

#include <string>

#include "autopilot/controller/cascaded_controller.hpp"
#include "autopilot/handover.hpp"

namespace ironbird::autopilot {

/// What the follower asks for.
inline const ControlSetpoint kSomething = AngleHeadingRateThrust{0.0, 0.0, 0.0, 38.0};

/// An armed vehicle on the ground with a good estimate, and the controller that flies it.
class CascadedControllerTest : public ::testing::Test {
 protected:
  CascadedControllerTest() {
    estimate_.health = Health::kGood;
    estimate_.p_NB_N << 3.0, 4.0, 0.0;
    estimate_.heading = 0.5;
    status_.armed = true;
  }

  const FcuCommand& run(const ControlSetpoint& setpoint = kSomething, bool landing = false) {
    estimate_.stamp += std::chrono::microseconds(2500);
    return controller_.run(setpoint, landing, estimate_, status_);
  }

  void run_for(double seconds, const ControlSetpoint& setpoint = kSomething) {
    for (int i = 0; i < seconds / 0.0025; ++i) run(setpoint);
  }

  void set(void (*change)(CascadedControllerParams&)) {
    CascadedControllerParams params = controller_.params();
    change(params);
    controller_.set_params(params);
  }

  void ask(FlightWish wish) {
    const RequestOutcome outcome = controller_.request(wish, estimate_, status_);
    ASSERT_TRUE(outcome.accepted) << outcome.reason;
  }

  std::string refusal(FlightWish wish) { return controller_.request(wish, estimate_, status_).reason; }

  bool is_silent() { return std::holds_alternative<SilenceCommand>(run()); }

  void fly_offboard() {
    ask(FlightWish::kTakeOff);
    run();
    estimate_.p_NB_N.z() = -2.0;
    run_for(1.1);
    ASSERT_EQ(controller_.phase(), FlightPhase::kOffboard);
  }

  /// Arming, seen by the controller, that is the request to take off.
  void arm_with_take_off() {
    set([](CascadedControllerParams& p) { p.take_off_on_arming = true; });
    status_.armed = false;
    status_.stamp = std::chrono::milliseconds(1);
    run();
    status_.armed = true;
  }

  CascadedController controller_;
  StateEstimate estimate_;
  FcuStatus status_;
};

}  // namespace ironbird::autopilot
