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
    ASSERT_EQ(controller_.phase(), kOffboard);
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
  run();
  const double high = std::get<PassThroughCommand>(run()).thrust;
  estimate_.p_NB_N.z() = -2.0;
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, high + 1.0);
}

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

TEST_F(CascadedControllerTest, SaysNothingOnAnEstimateThatIsLostAndLandsWhenItIsSoonBack) {
  fly_offboard();
  estimate_.health = Health::kLost;
  EXPECT_TRUE(is_silent());
  EXPECT_EQ(controller_.phase(), kSilent);
  EXPECT_EQ(controller_.cause(), PhaseCause::kEstimateLost);
  estimate_.health = Health::kGood;
  EXPECT_FALSE(is_silent());
  EXPECT_EQ(controller_.phase(), kLanding) << "not back to the mission by itself";
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
    EXPECT_TRUE(is_silent());
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
Signals left_by(const Controller& controller, const StateEstimate& estimate) {
  Signals signals;
  signals.estimate = estimate;
  signals.flight.phase = controller.phase();
  signals.flight.cause = controller.cause();
  signals.flight.memory = controller.memory();
  return signals;
}

TEST_F(CascadedControllerTest, TakesOverThePhaseOfItsPredecessor) {
  Signals signals;
  signals.flight.phase = kOffboard;
  controller_.take_over(signals);
  EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust, 38.0, 1e-9);
  EXPECT_EQ(controller_.phase(), kOffboard);
}

TEST_F(CascadedControllerTest, GoesOnWithTheClimbOfItsPredecessor) {
  // GIVEN a climb that began at 10 m and has come to 11.4 m
  estimate_.p_NB_N << 3.0, 4.0, -10.0;
  ask(FlightWish::kTakeOff);
  run();
  estimate_.p_NB_N << 3.2, 4.0, -11.4;
  run();
  CascadedController successor;
  successor.take_over(left_by(controller_, estimate_));
  const auto step = [&] {
    estimate_.stamp += std::chrono::microseconds(2500);
    return successor.run(kSomething, false, estimate_, status_);
  };
  step();
  EXPECT_EQ(successor.phase(), kTakeOff);
  EXPECT_EQ(successor.memory().point_N.x(), 3.0) << "over the place where it began";
  // WHEN it has come within half a metre of 2 m above the beginning THEN it holds, not 2 m further up
  estimate_.p_NB_N.z() = -11.6;
  step();
  EXPECT_EQ(successor.phase(), kHold);
  EXPECT_EQ(successor.memory().point_N.z(), -12.0);
}

TEST_F(CascadedControllerTest, KeepsTheMotorsStillOnTheGroundAfterItsPredecessorsLanding) {
  fly_offboard();
  ask(FlightWish::kLand);
  run_for(2.0);
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  CascadedController successor;
  successor.take_over(left_by(controller_, estimate_));
  estimate_.stamp += std::chrono::microseconds(2500);
  EXPECT_EQ(std::get<PassThroughCommand>(successor.run(kSomething, false, estimate_, status_)).thrust, 0.0);
  EXPECT_EQ(successor.memory().launch_N, Vector3(3.0, 4.0, 0.0));
}

}  // namespace
}  // namespace ironbird::autopilot
