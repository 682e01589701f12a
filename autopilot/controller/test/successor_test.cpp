#include <gtest/gtest.h>

#include "autopilot/controller/test/cascaded_controller_flight.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

/// A controller in the place of another.
class SuccessorTest : public CascadedControllerTest {
 protected:
  static Signals left_by(const Controller& controller, const StateEstimate& estimate) {
    Signals signals;
    signals.estimate = estimate;
    signals.flight.phase = controller.phase();
    signals.flight.cause = controller.cause();
    signals.flight.memory = controller.memory();
    return signals;
  }

  void succeed() { successor_.take_over(left_by(controller_, estimate_)); }

  const FcuCommand& step(const ControlSetpoint& setpoint = kSomething) {
    estimate_.stamp += std::chrono::microseconds(2500);
    return successor_.run(setpoint, false, estimate_, status_);
  }

  CascadedController successor_;
};

TEST_F(SuccessorTest, TakesOverThePhaseOfItsPredecessor) {
  Signals signals;
  signals.flight.phase = kOffboard;
  controller_.take_over(signals);
  EXPECT_NEAR(std::get<PassThroughCommand>(run()).thrust, 38.0, 1e-9);
  EXPECT_EQ(controller_.phase(), kOffboard);
}

TEST_F(SuccessorTest, GoesOnWithTheClimbOfItsPredecessor) {
  // GIVEN a climb that began at 10 m and has come to 11.4 m
  estimate_.p_NB_N << 3.0, 4.0, -10.0;
  ask(FlightWish::kTakeOff);
  run();
  estimate_.p_NB_N << 3.2, 4.0, -11.4;
  run();
  succeed();
  step();
  EXPECT_EQ(successor_.phase(), kTakeOff);
  EXPECT_EQ(successor_.memory().point_N.x(), 3.0) << "over the place where it began";
  // WHEN it has come within half a metre of 2 m above the beginning THEN it holds, not 2 m further up
  estimate_.p_NB_N.z() = -11.6;
  step();
  EXPECT_EQ(successor_.phase(), kHold);
  EXPECT_EQ(successor_.memory().point_N.z(), -12.0);
}

TEST_F(SuccessorTest, KeepsTheMotorsStillOnTheGroundAfterItsPredecessorsLanding) {
  fly_offboard();
  ask(FlightWish::kLand);
  run_for(2.0);
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  succeed();
  EXPECT_EQ(std::get<PassThroughCommand>(step()).thrust, 0.0);
  EXPECT_EQ(successor_.memory().launch_N, Vector3(3.0, 4.0, 0.0));
}

TEST_F(SuccessorTest, BeginsALandingThatItsPredecessorWasAskedForAsThatWould) {
  // GIVEN a vehicle that is just braking a fast descent at full thrust
  fly_offboard();
  estimate_.p_NB_N.z() = -30.0;
  estimate_.v_NB_B.z() = 3.0;
  run();
  ask(FlightWish::kLand);
  Signals last = left_by(controller_, estimate_);
  last.command = PassThroughCommand{Vector3::Zero(), 75.0};
  Handover left(last);
  controller_.hand_over(left);
  successor_.take_over(left);
  // WHEN both go on THEN the new one does not hold on to the thrust of the moment before
  const double of_successor = std::get<PassThroughCommand>(step()).thrust;
  const double of_predecessor = std::get<PassThroughCommand>(run()).thrust;
  EXPECT_EQ(successor_.phase(), kLanding);
  EXPECT_NEAR(of_successor, of_predecessor, 0.5);
}

TEST_F(SuccessorTest, TakesOffWhenItsPredecessorHasJustSeenTheArmingThatAsksForIt) {
  arm_with_take_off();
  estimate_.health = Health::kUninitialised;  // not yet, as the predecessor sees it
  run();
  ASSERT_EQ(controller_.phase(), kDisarmed);
  successor_.set_params(controller_.params());
  Handover left(left_by(controller_, estimate_));
  controller_.hand_over(left);
  successor_.take_over(left);
  estimate_.health = Health::kGood;
  step();
  EXPECT_EQ(successor_.phase(), kTakeOff);
}

TEST_F(SuccessorTest, LeavesTheMotorsOfAVehicleStoppedThatWasOutOfControl) {
  fly_offboard();
  estimate_.q_NB = Quaternion(0.0, 1.0, 0.0, 0.0);
  estimate_.v_NB_B.x() = 2.0;
  run_for(3.1);
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  succeed();
  EXPECT_EQ(std::get<PassThroughCommand>(step()).thrust, 0.0);
  // WHEN the pilot has it upright THEN it flies
  estimate_.q_NB = Quaternion::Identity();
  status_.rc_override = 0x003;
  for (int i = 0; i < 210; ++i) step();
  status_.rc_override = 0;
  EXPECT_GT(std::get<PassThroughCommand>(step()).thrust, 0.0);
}

TEST_F(SuccessorTest, KeepsAVehicleUpWhoseEstimateWasLostInTheAirForWhatIsLeftOfThePatience) {
  fly_offboard();
  estimate_.health = Health::kLost;
  run_for(1.0);
  succeed();
  const int left = static_cast<int>((controller_.params().silence_patience - 1.0) / 0.0025);
  for (int i = 0; i < left - 4; ++i) {
    ASSERT_GT(std::get<PassThroughCommand>(step()).thrust, 0.9 * 3.9 * 9.81) << i;
  }
  for (int i = 0; i < 8; ++i) step();
  EXPECT_TRUE(std::holds_alternative<SilenceCommand>(step()));
}

TEST_F(SuccessorTest, GivesNoThrustToAVehicleThatWasHandedBackOnTheGroundAMomentAgo) {
  fly_offboard();
  // GIVEN motors that idled in the pilot's hands when he handed over
  status_.rc_override = 0x003;
  status_.greatest_output = 0.1;
  estimate_.v_NB_B.z() = 0.5;
  run_for(0.1);
  status_.rc_override = 0;
  ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  succeed();
  for (int i = 0; i < 40; ++i) ASSERT_EQ(std::get<PassThroughCommand>(step()).thrust, 0.0);
}

}  // namespace
}  // namespace ironbird::autopilot
