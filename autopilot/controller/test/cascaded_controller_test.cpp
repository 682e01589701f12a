#include <gtest/gtest.h>

#include "autopilot/controller/test/cascaded_controller_flight.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

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
  // WHEN asked to take off THEN it climbs with more than its weight
  ask(FlightWish::kTakeOff);
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
  arm_with_take_off();
  run(NoSetpoint{});
  EXPECT_EQ(controller_.phase(), kDisarmed);
  run();
  EXPECT_EQ(controller_.phase(), kTakeOff);
}

TEST_F(CascadedControllerTest, ForgetsThatArmingWasARequestAfterAWhile) {
  arm_with_take_off();
  run_for(controller_.params().arming_patience + 0.1, NoSetpoint{});
  EXPECT_TRUE(is_silent());
  EXPECT_EQ(controller_.phase(), kDisarmed);
}

TEST_F(CascadedControllerTest, DoesNotTakeItForArmingWhenItComesLate) {
  set([](CascadedControllerParams& p) { p.take_off_on_arming = true; });
  run_for(1.0);
  EXPECT_EQ(controller_.phase(), kDisarmed) << "the vehicle was armed before this controller flew it";
}

TEST_F(CascadedControllerTest, RefusesATakeOffThatCannotBeNowAndForgetsIt) {
  const FcuStatus good = status_;
  const auto refuses = [&](const char* reason) {
    EXPECT_NE(refusal(FlightWish::kTakeOff).find(reason), std::string::npos) << reason;
    run();
    status_ = good;
    estimate_.health = Health::kGood;
    estimate_.position_known = true;
    run_for(0.1);
    EXPECT_EQ(controller_.phase(), kDisarmed) << reason;
  };
  status_.armed = false;
  refuses("not armed");
  status_.failsafe = true;
  refuses("failsafe");
  status_.rc_override = 0x001;
  refuses("pilot");
  estimate_.health = Health::kLost;
  refuses("no estimate");
  estimate_.position_known = false;
  refuses("position");
}

TEST_F(CascadedControllerTest, RefusesToLandOrFlyOnWhenItStands) {
  EXPECT_NE(refusal(FlightWish::kLand), "");
  EXPECT_NE(refusal(FlightWish::kResume), "");
  fly_offboard();
  EXPECT_NE(refusal(FlightWish::kTakeOff), "");
  EXPECT_NE(refusal(FlightWish::kResume), "");
}

TEST_F(CascadedControllerTest, NeedsANewRequestAfterItWasSetDownByThePilot) {
  fly_offboard();
  // GIVEN the pilot takes it down and it lies there
  status_.rc_override = 0x003;
  estimate_.v_NB_B.z() = 0.5;
  run_for(2.0);
  EXPECT_EQ(controller_.phase(), kOffboard) << "it sinks";
  estimate_.v_NB_B.z() = 0.0;
  estimate_.p_NB_N.z() = 0.1;
  run_for(0.5);
  EXPECT_EQ(controller_.phase(), kDisarmed);
  EXPECT_EQ(controller_.cause(), PhaseCause::kRestsWithPilot);
  // WHEN the pilot hands over
  status_.rc_override = 0;
  // THEN no propeller turns, until somebody asks
  for (int i = 0; i < 4000; ++i) ASSERT_TRUE(is_silent());
  ask(FlightWish::kTakeOff);
  EXPECT_FALSE(is_silent());
}

TEST_F(CascadedControllerTest, IsInNoHurryToBelieveItLiesFarBelowItsLaunch) {
  // GIVEN a launch from a roof, a flight twelve metres below it, and a pilot who hovers very still
  estimate_.p_NB_N.z() = -24.0;
  ask(FlightWish::kTakeOff);
  run();
  estimate_.p_NB_N.z() = -26.0;
  run_for(1.1);
  estimate_.p_NB_N.z() = -12.0;
  status_.rc_override = 0x003;
  run_for(controller_.params().rest_time - 0.1);
  EXPECT_EQ(controller_.phase(), kOffboard);
  // WHEN the estimate is lost there THEN it is kept up
  status_.rc_override = 0;
  estimate_.health = Health::kLost;
  EXPECT_FALSE(is_silent());
}

TEST_F(CascadedControllerTest, NeedsANewRequestAfterAFailsafeTookItDownOnAHill) {
  fly_offboard();
  status_.failsafe = true;
  estimate_.p_NB_N.z() = -30.0;
  run_for(controller_.params().rest_time + 0.1);
  status_.failsafe = false;
  EXPECT_TRUE(is_silent());
  EXPECT_EQ(controller_.phase(), kDisarmed);
}

TEST_F(CascadedControllerTest, FliesOnAfterAFailsafeInTheAir) {
  fly_offboard();
  status_.failsafe = true;
  estimate_.v_NB_B.z() = 0.3;
  run_for(20.0);
  status_.failsafe = false;
  EXPECT_FALSE(is_silent());
  EXPECT_EQ(controller_.phase(), kOffboard);
}

TEST_F(CascadedControllerTest, DescendsLevelWhenThePositionIsNotKnown) {
  fly_offboard();
  // GIVEN an estimate that says it is far off and fast, and does not know where it is
  estimate_.position_known = false;
  estimate_.p_NB_N << 500.0, -300.0, -10.0;
  estimate_.v_NB_B << 12.0, -5.0, 0.0;
  // THEN nobody leans against that, and it sinks
  const auto command = std::get<PassThroughCommand>(run());
  EXPECT_EQ(controller_.phase(), kLevelDescent);
  EXPECT_EQ(controller_.cause(), PhaseCause::kPositionUnknown);
  EXPECT_LT(command.M_B.norm(), 1e-9);
  EXPECT_LT(command.thrust, 3.9 * 9.81);
  // WHEN it feels the ground THEN there is no thrust
  estimate_.v_NB_B.setZero();
  estimate_.p_NB_N.z() = -1.0;
  run_for(2.0);
  EXPECT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
}

TEST_F(CascadedControllerTest, LandsOnThePositionWhenItIsKnownAgainAndFliesOnOnlyByRequest) {
  fly_offboard();
  estimate_.position_known = false;
  run();
  estimate_.position_known = true;
  run();
  EXPECT_EQ(controller_.phase(), kLanding);
  estimate_.v_NB_B.z() = 0.4;
  run_for(3.0);
  EXPECT_EQ(controller_.phase(), kLanding);
  ask(FlightWish::kResume);
  run();
  EXPECT_EQ(controller_.phase(), kHold);
  run_for(1.1);
  EXPECT_EQ(controller_.phase(), kOffboard);
}

TEST_F(CascadedControllerTest, TakesOffByThrottleWhenToldTo) {
  set([](CascadedControllerParams& p) { p.take_off_pass_through = false; });
  ask(FlightWish::kTakeOff);
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
  ask(FlightWish::kLand);
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
  ask(FlightWish::kLand);
  estimate_.v_NB_B.z() = controller_.params().descent_speed;
  run_for(1.0);
  const double high = std::get<PassThroughCommand>(run()).thrust;
  estimate_.p_NB_N.z() = -2.0;
  run_for(0.1);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, high + 1.0);
}

}  // namespace
}  // namespace ironbird::autopilot
