#include "autopilot/controller/cascaded_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "autopilot/signals.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

const ControlSetpoint kSomething = AngleHeadingRateThrust{0.0, 0.0, 0.0, 38.0};

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

  void fly_offboard() {
    controller_.request_take_off();
    run();
    estimate_.p_NB_N.z() = -2.0;
    run_for(1.1);
    ASSERT_EQ(controller_.phase(), kOffboard);
  }

  CascadedController controller_;
  StateEstimate estimate_;
  FcuStatus status_;
};

TEST_F(CascadedControllerTest, IsSilentUntilATakeOffIsRequested) {
  EXPECT_TRUE(std::holds_alternative<SilenceCommand>(run()));
  EXPECT_EQ(controller_.phase(), kDisarmed);
}

TEST_F(CascadedControllerTest, SendsZerosWhileDisarmedWhenToldTo) {
  set([](CascadedControllerParams& p) { p.zeros_while_disarmed = true; });
  status_.armed = false;
  const auto command = std::get<PassThroughCommand>(run());
  EXPECT_EQ(command.thrust, 0.0);
  EXPECT_EQ(command.M_B, Vector3::Zero());
}

TEST_F(CascadedControllerTest, ClimbsHoldsAndFliesWhatItIsGiven) {
  // GIVEN a request before arming
  status_.armed = false;
  controller_.request_take_off();
  run();
  EXPECT_EQ(controller_.phase(), kDisarmed);
  // WHEN armed THEN it climbs with more than its weight
  status_.armed = true;
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 3.9 * 9.81);
  EXPECT_EQ(controller_.phase(), kTakeOff);
  // WHEN within half a metre of two metres THEN it holds for a second
  estimate_.p_NB_N.z() = -1.6;
  run();
  EXPECT_EQ(controller_.phase(), kHold);
  run_for(0.99);
  EXPECT_EQ(controller_.phase(), kHold);
  run_for(0.02);
  EXPECT_EQ(controller_.phase(), kOffboard);
  EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust, 38.0, 1e-9);
}

TEST_F(CascadedControllerTest, TakesOffOnArmingWhenToldToOnceThereIsSomethingToFly) {
  set([](CascadedControllerParams& p) { p.take_off_on_arming = true; });
  run(NoSetpoint{});
  EXPECT_EQ(controller_.phase(), kDisarmed);
  run();
  EXPECT_EQ(controller_.phase(), kTakeOff);
}

TEST_F(CascadedControllerTest, TakesOffByThrottleWhenToldTo) {
  set([](CascadedControllerParams& p) { p.take_off_pass_through = false; });
  controller_.request_take_off();
  EXPECT_GT(std::get<AngleCommand>(run()).throttle, controller_.params().equilibrium_throttle);
}

TEST_F(CascadedControllerTest, ChoosesTheOutputOfAccelerationEntries) {
  fly_offboard();
  const ControlSetpoint hover = AccelerationHeadingRate{};
  EXPECT_TRUE(std::holds_alternative<PassThroughCommand>(run(hover)));
  set([](CascadedControllerParams& p) { p.acceleration_output = 0; });
  EXPECT_TRUE(std::holds_alternative<AngleCommand>(run(hover)));
}

TEST_F(CascadedControllerTest, HoldsWhereItIsWhenTheSetpointIsGone) {
  fly_offboard();
  estimate_.p_NB_N << 10.0, 20.0, -7.0;
  const auto command = std::get<PassThroughCommand>(run(NoSetpoint{}));
  EXPECT_EQ(controller_.phase(), kHold);
  EXPECT_NEAR(command.thrust, 3.9 * 9.81, 1e-9);
  EXPECT_LT(command.M_B.norm(), 1e-9) << "it is where it wants to be";
}

TEST_F(CascadedControllerTest, LandsByRequestAndStopsItsMotorsOnTheGround) {
  fly_offboard();
  controller_.request_landing();
  run();
  EXPECT_EQ(controller_.phase(), kLanding);
  // WHEN it sinks THEN it does not feel the ground
  estimate_.v_NB_B.z() = 0.4;
  run_for(5.0);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0);
  // WHEN it no longer moves THEN there is no thrust after a second
  estimate_.v_NB_B.z() = 0.0;
  run_for(0.9);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0);
  run_for(0.2);
  EXPECT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  EXPECT_EQ(controller_.phase(), kLanding) << "only the pilot can disarm";
  // WHEN the pilot disarms THEN the landing is over
  status_.armed = false;
  EXPECT_TRUE(std::holds_alternative<SilenceCommand>(run()));
  EXPECT_EQ(controller_.phase(), kDisarmed);
  status_.armed = true;
  run();
  EXPECT_EQ(controller_.phase(), kDisarmed) << "a landing does not leave a wish to take off";
}

TEST_F(CascadedControllerTest, LandsWhereTheRouteLands) {
  fly_offboard();
  run(kSomething, true);
  EXPECT_EQ(controller_.phase(), kLanding);
}

TEST_F(CascadedControllerTest, DescendsFastOnlyWhenHigh) {
  fly_offboard();
  estimate_.p_NB_N.z() = -30.0;
  controller_.request_landing();
  run();
  const double high = std::get<PassThroughCommand>(run()).thrust;
  estimate_.p_NB_N.z() = -2.0;
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, high + 1.0);
}

TEST_F(CascadedControllerTest, DoesNotWindUpWhileThePilotFlies) {
  fly_offboard();
  const ControlSetpoint climbing = VelocityHeadingRate{Vector3(0.0, 0.0, -1.0), 0.0};
  const double at_first = std::get<PassThroughCommand>(run(climbing)).thrust;
  status_.rc_override = 1;
  run_for(20.0, climbing);
  EXPECT_NEAR(std::get<PassThroughCommand>(run(climbing)).thrust, at_first, 3.9 * 1.0 * 0.01)
      << "no more than one step of the integral";
  status_.rc_override = 0;
  status_.failsafe = true;
  run_for(20.0, climbing);
  EXPECT_NEAR(std::get<PassThroughCommand>(run(climbing)).thrust, at_first, 3.9 * 1.0 * 0.01);
}

TEST_F(CascadedControllerTest, HoldsWhereThePilotLeftTheVehicle) {
  controller_.request_take_off();
  run();
  estimate_.p_NB_N.z() = -2.0;
  run(NoSetpoint{});
  ASSERT_EQ(controller_.phase(), kHold);
  status_.rc_override = 1;
  estimate_.p_NB_N << 30.0, -20.0, -9.0;
  run_for(1.0, NoSetpoint{});
  status_.rc_override = 0;
  const auto command = std::get<PassThroughCommand>(run(NoSetpoint{}));
  EXPECT_NEAR(command.thrust, 3.9 * 9.81, 1e-9);
  EXPECT_LT(command.M_B.norm(), 1e-9);
}

TEST_F(CascadedControllerTest, SaysNothingOnAnEstimateThatIsLost) {
  fly_offboard();
  estimate_.health = Health::kLost;
  EXPECT_TRUE(std::holds_alternative<SilenceCommand>(run()));
  estimate_.health = Health::kGood;
  EXPECT_TRUE(std::holds_alternative<PassThroughCommand>(run()));
}

TEST_F(CascadedControllerTest, NeverSendsAValueThatIsNotFinite) {
  fly_offboard();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  run(AngleHeadingRateThrust{nan, 0.0, 0.0, 38.0});
  EXPECT_EQ(controller_.phase(), kHold) << "taken as no setpoint";
  run_for(1.1);
  StateEstimate good = estimate_;
  for (double* value :
       {&estimate_.roll, &estimate_.p_NB_N.x(), &estimate_.v_NB_B.y(), &estimate_.w_NB_B.z()}) {
    *value = nan;
    EXPECT_TRUE(std::holds_alternative<SilenceCommand>(run()));
    good.stamp = estimate_.stamp;
    estimate_ = good;
    const auto command = std::get<PassThroughCommand>(run());
    EXPECT_TRUE(command.M_B.allFinite() && std::isfinite(command.thrust));
  }
}

TEST_F(CascadedControllerTest, SurvivesAGapOfTheEstimateWithoutAKick) {
  fly_offboard();
  const ControlSetpoint still = VelocityHeadingRate{};
  run_for(0.5, still);
  estimate_.stamp += std::chrono::seconds(5);
  const auto command = std::get<PassThroughCommand>(run(still));
  EXPECT_NEAR(command.thrust, 3.9 * 9.81, 0.1);
}

TEST_F(CascadedControllerTest, TakesOffAgainAfterALandingByRequest) {
  fly_offboard();
  controller_.request_landing();
  run_for(2.0);
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  controller_.request_take_off();
  run();
  EXPECT_EQ(controller_.phase(), kTakeOff);
}

TEST_F(CascadedControllerTest, TakesOverThePhaseOfItsPredecessor) {
  Signals signals;
  signals.flight.phase = kOffboard;
  controller_.take_over(signals);
  EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust, 38.0, 1e-9);
  EXPECT_EQ(controller_.phase(), kOffboard);
}

}  // namespace
}  // namespace ironbird::autopilot
