#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "autopilot/controller/test/cascaded_controller_flight.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

TEST_F(CascadedControllerTest, DoesNotWindUpWhileThePilotFlies) {
  fly_offboard();
  estimate_.w_NB_B.x() = 0.1;  // in the air nothing lies quite still
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
  ask(FlightWish::kTakeOff);
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

TEST_F(CascadedControllerTest, ClimbsOnWhereThePilotLeftTheVehicle) {
  ask(FlightWish::kTakeOff);
  run();
  // GIVEN a pilot who takes the vehicle 30 m aside in the middle of the climb
  estimate_.p_NB_N.z() = -1.0;
  status_.rc_override = 1;
  run();
  estimate_.p_NB_N << 33.0, 4.0, -1.0;
  run_for(0.1);
  // WHEN the pilot hands over THEN it climbs level, there
  status_.rc_override = 0;
  const auto climb = std::get<PassThroughCommand>(run());
  ASSERT_EQ(controller_.phase(), kTakeOff);
  EXPECT_LT(climb.M_B.norm(), 1e-6);
}

TEST_F(CascadedControllerTest, DoesNotTakeASlowDescentForTheGround) {
  // GIVEN a slow descent of a vehicle that weighs less than thought, so that little lift is asked for
  set([](CascadedControllerParams& p) { p.landing_speed = 0.2; });
  fly_offboard();
  ask(FlightWish::kLand);
  run();
  // WHEN it sinks at more than half of what it was told, though slower than `touch_down_speed`
  estimate_.v_NB_B.z() = 0.12;
  run_for(10.0);
  // THEN the motors go on
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0);
}

TEST_F(CascadedControllerTest, StaysLevelInTheAirForAWhileWithoutAnEstimate) {
  const double weight = controller_.params().mass * controller_.params().gravity;
  fly_offboard();
  estimate_.health = Health::kLost;
  estimate_.roll = 0.1;
  // WHEN it still knows how it leans THEN it turns back, with nearly its weight as thrust
  auto command = std::get<PassThroughCommand>(run());
  EXPECT_LT(command.M_B.x(), 0.0);
  EXPECT_NEAR(command.thrust / weight, 0.97, 0.01);
  // WHEN it does not THEN it does not turn
  estimate_.sigma_attitude.setConstant(3.0);
  command = std::get<PassThroughCommand>(run());
  EXPECT_EQ(command.M_B.norm(), 0.0);
  EXPECT_NEAR(command.thrust / weight, 0.97, 0.01);
  // AND after `silence_patience`, or when the pilot has it, it says nothing
  status_.rc_override = 1;
  EXPECT_TRUE(is_silent());
  status_.rc_override = 0;
  EXPECT_FALSE(is_silent());
  run_for(controller_.params().silence_patience);
  EXPECT_TRUE(is_silent());
}

TEST_F(CascadedControllerTest, HoldsABlindVehicleUpWithWhatHasCarriedItNotWithWhatItIsSaidToWeigh) {
  for (const double weight : {30.0, 46.0}) {
    controller_.reset();
    estimate_.health = Health::kGood;
    estimate_.p_NB_N.z() = 0.0;
    fly_offboard();
    run_for(20.0, AngleHeadingRateThrust{0.0, 0.0, 0.0, weight});
    estimate_.health = Health::kLost;
    EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust, 0.97 * weight, 0.1);
  }
}

TEST_F(CascadedControllerTest, HoldsAPositionInDoubtThenLandsThere) {
  fly_offboard();
  estimate_.position_doubtful = true;
  run();
  EXPECT_EQ(controller_.phase(), kHold);
  EXPECT_EQ(controller_.cause(), PhaseCause::kPositionDoubtful);
  run_for(controller_.params().doubt_patience - 0.1);
  EXPECT_EQ(controller_.phase(), kHold);
  run_for(0.2);
  EXPECT_EQ(controller_.phase(), kLanding);
  // WHEN the operator resumes THEN it holds as long again
  ask(FlightWish::kResume);
  run_for(controller_.params().doubt_patience - 0.1);
  EXPECT_EQ(controller_.phase(), kHold);
  // WHEN the doubt is over THEN it flies on
  estimate_.position_doubtful = false;
  run();
  EXPECT_EQ(controller_.phase(), kOffboard);
}

TEST_F(CascadedControllerTest, CountsADoubtFromItsBeginningHoweverLongItHasHeld) {
  fly_offboard();
  run_for(60.0, NoSetpoint{});
  ASSERT_EQ(controller_.phase(), kHold);
  estimate_.position_doubtful = true;
  run_for(controller_.params().doubt_patience - 0.1, NoSetpoint{});
  EXPECT_EQ(controller_.phase(), kHold);
  run_for(0.2, NoSetpoint{});
  EXPECT_EQ(controller_.phase(), kLanding);
}

TEST_F(CascadedControllerTest, ComesToRestWithoutALurchWhenItsPositionIsInDoubt) {
  fly_offboard();
  estimate_.v_NB_B.x() = 3.0;
  estimate_.position_doubtful = true;
  const auto command = std::get<PassThroughCommand>(run());
  EXPECT_EQ(controller_.phase(), kHold);
  EXPECT_LT(command.M_B.norm(), 0.05) << "N m";
}

TEST_F(CascadedControllerTest, DoesNotChaseAPositionThatJumps) {
  fly_offboard();
  run(NoSetpoint{});
  ASSERT_EQ(controller_.phase(), kHold);
  const auto calm = std::get<PassThroughCommand>(run(NoSetpoint{}));
  // WHEN it jumps twice before the next step
  for (const double jump : {310.0, -10.0}) {
    estimate_.p_NB_N.x() += jump;
    estimate_.position_reset_sum_N.x() += jump;
    ++estimate_.position_resets;
  }
  const auto after = std::get<PassThroughCommand>(run(NoSetpoint{}));
  EXPECT_LT((after.M_B - calm.M_B).norm(), 1e-9);
}

TEST_F(CascadedControllerTest, ComesDownInsteadOfFallingWhenTheEstimateIsLostNearTheGround) {
  const double weight = controller_.params().mass * controller_.params().gravity;
  fly_offboard();
  estimate_.p_NB_N.z() = -0.9;
  estimate_.health = Health::kLost;
  EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust / weight, 0.85, 0.01);
  run_for(controller_.params().silence_patience);
  EXPECT_TRUE(is_silent());
}

TEST_F(CascadedControllerTest, SaysNothingOnTheGroundOnALostEstimateAndLandsWhenItIsSoonBack) {
  fly_offboard();
  estimate_.p_NB_N.z() = -0.2;
  estimate_.health = Health::kLost;
  EXPECT_TRUE(is_silent());
  EXPECT_EQ(controller_.phase(), kSilent);
  EXPECT_EQ(controller_.cause(), PhaseCause::kEstimateLost);
  estimate_.health = Health::kGood;
  EXPECT_FALSE(is_silent());
  EXPECT_EQ(controller_.phase(), kLanding) << "not back to the mission by itself";
}

TEST_F(CascadedControllerTest, FallsSilentThoughTheStampOfALostEstimateStandsStill) {
  for (const Time period : {Time{0}, Time{std::chrono::milliseconds(10)}}) {
    controller_.set_period(period);
    controller_.reset();
    estimate_.health = Health::kGood;
    estimate_.p_NB_N.z() = 0.0;
    ask(FlightWish::kTakeOff);
    run_for(0.1);
    estimate_.p_NB_N.z() = -2.0;
    run_for(0.1);
    estimate_.health = Health::kLost;
    const auto again = [&] { return controller_.run(kSomething, false, estimate_, status_); };
    for (int i = 0; i < 50; ++i) ASSERT_NEAR(std::get<PassThroughCommand>(again()).thrust, 37.1, 0.1);
    for (int i = 0; i < 100; ++i) again();
    EXPECT_TRUE(std::holds_alternative<SilenceCommand>(again())) << seconds(period) << " s";
  }
}

TEST_F(CascadedControllerTest, StaysSilentAfterALongLossUntilAskedToFlyOn) {
  fly_offboard();
  estimate_.health = Health::kLost;
  run_for(controller_.params().silence_patience + 0.1);
  EXPECT_NE(refusal(FlightWish::kResume), "");
  estimate_.health = Health::kGood;
  for (int i = 0; i < 4000; ++i) ASSERT_TRUE(is_silent());
  ask(FlightWish::kResume);
  EXPECT_FALSE(is_silent());
  EXPECT_EQ(controller_.phase(), kHold);
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
    const auto blind = std::get<PassThroughCommand>(run());
    EXPECT_TRUE(blind.M_B.allFinite() && std::isfinite(blind.thrust));
    EXPECT_EQ(controller_.phase(), kSilent);
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
  ask(FlightWish::kLand);
  run_for(2.0);
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  ask(FlightWish::kTakeOff);
  run();
  EXPECT_EQ(controller_.phase(), kTakeOff);
}

/// What the autopilot would hand to a successor.
TEST_F(CascadedControllerTest, GivesAVehicleThatLiesOnItsBackNoThrust) {
  fly_offboard();
  estimate_.q_NB = Quaternion(0.0, 1.0, 0.0, 0.0);
  run_for(0.9);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0) << "it may still be turning over";
  run_for(0.2);
  const auto* command = std::get_if<PassThroughCommand>(&run());
  ASSERT_NE(command, nullptr);
  EXPECT_EQ(command->thrust, 0.0);
  EXPECT_EQ(command->M_B, Vector3::Zero());
}

TEST_F(CascadedControllerTest, FliesOnOnItsBackWhileItFalls) {
  fly_offboard();
  estimate_.q_NB = Quaternion(0.0, 1.0, 0.0, 0.0);
  estimate_.v_NB_B.z() = -3.0;  // down
  run_for(2.9);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0) << "it may right itself";
}

}  // namespace
}  // namespace ironbird::autopilot
