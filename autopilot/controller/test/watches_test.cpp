#include <gtest/gtest.h>

#include <numbers>

#include "autopilot/controller/descent.hpp"
#include "autopilot/controller/test/cascaded_controller_flight.hpp"
#include "autopilot/controller/upright_watch.hpp"

namespace ironbird::autopilot {
namespace {

Quaternion leaning(double degrees) {
  return Quaternion(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vector3::UnitX()));
}

class UprightWatchTest : public ::testing::Test {
 protected:
  void look(double seconds, double lean_degrees, std::optional<double> asked, bool taken = false) {
    estimate_.q_NB = leaning(lean_degrees);
    for (int i = 0; i < seconds / 0.01; ++i) {
      estimate_.stamp += std::chrono::milliseconds(10);
      watch_.look(estimate_, usable_, false, asked, taken);
    }
  }
  bool stops() const { return watch_.stops(estimate_.stamp); }

  UprightWatch watch_;
  StateEstimate estimate_;
  bool usable_ = true;
};

TEST_F(UprightWatchTest, StopsAVehicleThatTumblesThoughItIsAskedToBeUpright) {
  for (int turn = 0; turn < 10; ++turn) {  // upright for less than half a second of each turn
    look(0.2, 10.0, 1.0);
    look(0.1, 170.0, 1.0);
  }
  EXPECT_FALSE(stops()) << "three seconds, less the first moment upright";
  look(0.4, 100.0, 1.0);
  EXPECT_TRUE(stops());
  look(5.0, 0.0, 1.0);
  EXPECT_TRUE(stops()) << "it may only have come to rest on its feet";
}

TEST_F(UprightWatchTest, LetsAVehicleThatWasUpsetRightItself) {
  for (int upset = 0; upset < 5; ++upset) {
    look(2.5, 120.0, 1.0);
    look(0.6, 20.0, 1.0);
  }
  EXPECT_FALSE(stops());
}

TEST_F(UprightWatchTest, TakesNoVehicleForRightedThatLeansNearlyAsMuchAsBefore) {
  look(1.0, 120.0, 1.0);
  look(1.9, 55.0, 1.0);
  EXPECT_FALSE(stops());
  look(0.2, 55.0, 1.0);
  EXPECT_TRUE(stops());
}

TEST_F(UprightWatchTest, IsNotMisledByLoopsThatAskATumblingVehicleToLeanFarForAMoment) {
  for (int turn = 0; turn < 10; ++turn) {
    look(0.2, 120.0, 1.0);
    look(0.12, 120.0, 0.55);
  }
  EXPECT_TRUE(stops());
}

TEST_F(UprightWatchTest, CountsNoTimeInWhichItSawNothing) {
  look(2.0, 120.0, 1.0);
  usable_ = false;
  look(2.0, 120.0, 1.0);
  usable_ = true;
  look(0.9, 120.0, 1.0);
  EXPECT_FALSE(stops());
  look(0.2, 120.0, 1.0);
  ASSERT_TRUE(stops()) << "a crash may take the estimate for a moment: it goes on counting";
  // NOR is it upright in the pilot's hands because it was before and after
  look(0.2, 10.0, 1.0, true);
  usable_ = false;
  look(2.0, 10.0, 1.0, true);
  usable_ = true;
  look(0.2, 10.0, 1.0, true);
  EXPECT_TRUE(stops());
}

TEST_F(UprightWatchTest, LetsWhoAsksForItFlyOnItsSideOrTurnOver) {
  look(20.0, 80.0, 0.5);  // asked to lean 60 deg
  look(20.0, 170.0, std::nullopt);
  EXPECT_FALSE(stops());
}

TEST_F(UprightWatchTest, LeavesAVehicleToThePilotAndForgetsWhenHeHasItUpright) {
  look(20.0, 120.0, 1.0, true);
  EXPECT_FALSE(stops());
  look(3.1, 120.0, 1.0);
  ASSERT_TRUE(stops());
  look(0.6, 10.0, 1.0, true);
  EXPECT_FALSE(stops());
}

TEST_F(CascadedControllerTest, StopsTheMotorsOfAVehicleThatTumblesAndStaysSoUntilDisarmed) {
  fly_offboard();
  estimate_.q_NB = leaning(110.0);
  estimate_.w_NB_B.x() = 8.0;
  estimate_.v_NB_B.x() = 2.0;
  run_for(2.9);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0);
  run_for(0.2);
  EXPECT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  // WHEN the estimate is lost THEN it does not leave the motors to the pilot's sticks
  estimate_.health = Health::kLost;
  EXPECT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  // WHEN it is disarmed, stood up and armed THEN it may fly again
  estimate_.health = Health::kGood;
  status_.armed = false;
  run();
  estimate_.q_NB = Quaternion::Identity();
  estimate_.w_NB_B.setZero();
  estimate_.v_NB_B.setZero();
  status_.armed = true;
  run();
  ask(FlightWish::kTakeOff);
  EXPECT_GT(std::get<PassThroughCommand>(run()).thrust, 0.0);
}

TEST_F(CascadedControllerTest, TakesNoOverturnedVehicleOffHoweverItIsAsked) {
  // GIVEN a vehicle that is armed on its back
  arm_with_take_off();
  estimate_.q_NB = leaning(180.0);
  run_for(1.1);
  // THEN it is told to stop its motors: in silence the FCU would try to right it
  for (int i = 0; i < 400; ++i) ASSERT_EQ(std::get<PassThroughCommand>(run()).thrust, 0.0);
  EXPECT_NE(refusal(FlightWish::kTakeOff).find("overturned"), std::string::npos);
  // WHEN it turns over between the grant and the step THEN it stays down
  estimate_.q_NB = leaning(10.0);
  run(NoSetpoint{});
  ask(FlightWish::kTakeOff);
  estimate_.q_NB = leaning(70.0);
  EXPECT_TRUE(is_silent());
  // WHEN it stands THEN it may fly
  estimate_.q_NB = leaning(10.0);
  run(NoSetpoint{});
  ask(FlightWish::kTakeOff);
  EXPECT_FALSE(is_silent());
}

TEST_F(CascadedControllerTest, DoesNotFlyAgainWithoutDisarmingAfterItTumbledToTheGround) {
  fly_offboard();
  estimate_.q_NB = leaning(110.0);
  estimate_.v_NB_B.x() = 2.0;
  run_for(3.1);
  // WHEN it has come to rest on its feet with the pilot's sticks elsewhere, still armed
  estimate_.q_NB = leaning(0.0);
  estimate_.v_NB_B.setZero();
  estimate_.p_NB_N.z() = 0.0;
  status_.rc_override = 0x001;
  run_for(0.47);
  status_.rc_override = 0;
  run();
  ASSERT_EQ(controller_.phase(), FlightPhase::kDisarmed);
  EXPECT_NE(refusal(FlightWish::kTakeOff).find("disarm"), std::string::npos);
}

TEST_F(CascadedControllerTest, KnowsSoonThatAnOverturnedVehicleRestsWhereverItsEstimateIs) {
  fly_offboard();
  // GIVEN a vehicle that lies on its back while the pilot's sticks make its motors thrash, metres below where
  // it took off as far as the estimate knows
  estimate_.q_NB = leaning(180.0);
  estimate_.p_NB_N.z() = 4.0;
  status_.rc_override = 0x001;
  run_for(1.2);
  EXPECT_EQ(controller_.phase(), FlightPhase::kDisarmed);
  EXPECT_EQ(controller_.cause(), PhaseCause::kRestsWithPilot);
}

TEST_F(CascadedControllerTest, LetsAcrobaticsByRatesAndTorquesBe) {
  fly_offboard();
  estimate_.q_NB = leaning(110.0);
  estimate_.w_NB_B.x() = 3.0;
  estimate_.v_NB_B.x() = 2.0;
  run_for(10.0, RateThrust{Vector3(3.0, 0.0, 0.0), 38.0});
  EXPECT_GT(std::get<PassThroughCommand>(run(RateThrust{Vector3(3.0, 0.0, 0.0), 38.0})).thrust, 0.0);
  run_for(10.0, TorqueThrust{Vector3::Zero(), 38.0});
  EXPECT_GT(std::get<PassThroughCommand>(run(TorqueThrust{Vector3::Zero(), 38.0})).thrust, 0.0);
}

TEST(ApproachTest, BeginsWithTheVelocityThatItFinds) {
  for (const double speed : {0.6, 1.0, 2.0, 3.0, 4.5, 8.0, 15.0}) {
    Cascade cascade{CascadeParams{}};
    StateEstimate estimate;
    estimate.v_NB_B << 0.6 * speed, -0.8 * speed, 0.0;
    const Vector3 place_N = cascade.resting_place(estimate, 2.0);
    EXPECT_NEAR(place_N.norm(), speed <= 2.0 ? speed : speed * speed / 4.0 + 1.0, 1e-12);
    const FcuCommand command = cascade.come_to({place_N, 0.0, 0.0, 2.0}, estimate, {.dt = 0.0025});
    EXPECT_LT(std::get<PassThroughCommand>(command).M_B.norm(), 1e-9) << speed;
  }
}

TEST(ApproachTest, AsksForNoMoreThanItsDecelerationFromAnySpeed) {
  // GIVEN a vehicle that has exactly the velocity asked for
  CascadeParams params;
  params.vel_n_to_accel = {1.0, 0.0, 0.0};
  constexpr double kStep = 0.001;  // s
  StateEstimate estimate;
  estimate.v_NB_B.x() = 9.0;
  const Vector3 place_N = Cascade{params}.resting_place(estimate, 2.0);
  double greatest = 0.0;
  double speed = 9.0;
  for (int i = 0; i < 15000; ++i) {
    // THEN what is asked for beside it is how fast that velocity changes
    const auto wanted = [&](double north) {
      Cascade cascade{params};
      StateEstimate there;
      there.p_NB_N.x() = north;
      there.v_NB_B.x() = speed;
      const FcuCommand command = cascade.come_to({place_N, 0.0, 0.0, 2.0}, there, {1.0, false, false});
      return speed + 9.81 * std::tan(-std::get<AngleCommand>(command).pitch);
    };
    const double v = wanted(estimate.p_NB_N.x());
    const double next = wanted(estimate.p_NB_N.x() + v * kStep);
    greatest = std::max(greatest, (v - next) / kStep);
    speed = v;
    estimate.p_NB_N.x() += v * kStep;
  }
  EXPECT_NEAR(estimate.p_NB_N.x(), place_N.x(), 0.01);
  EXPECT_LT(greatest, 2.02);
  EXPECT_GT(greatest, 1.9);
}

constexpr double kBraking = 2.0;   // m/s^2
constexpr double kCatching = 8.0;  // m/s^2

TEST(DescentTest, SinksOnlyWhenTheVehicleHasComeToRestOverItsPlace) {
  Descent descent;
  StateEstimate estimate;
  const auto sink = [&](double speed) {
    estimate.v_NB_B.x() = speed;
    estimate.stamp += std::chrono::milliseconds(10);
    return descent.sink(estimate, 0.4, 0.01, kBraking, kCatching);
  };
  for (int i = 0; i < 100; ++i) ASSERT_EQ(sink(3.0 - 0.02 * i), 0.0);
  double v_down = 0.0;
  for (int i = 0; i < 50; ++i) v_down = sink(0.3);
  EXPECT_NEAR(v_down, 0.4, 1e-12);
  EXPECT_NEAR(sink(2.0), 0.4, 1e-12) << "a gust does not end the descent";
}

TEST(DescentTest, SinksInTheEndThoughTheWindDrivesItOn) {
  Descent descent;
  StateEstimate estimate;
  estimate.v_NB_B.x() = 3.0;
  double v_down = 0.0;
  for (int i = 0; i < 600; ++i) {
    estimate.stamp += std::chrono::milliseconds(10);
    v_down = descent.sink(estimate, 0.4, 0.01, kBraking, kCatching);
  }
  EXPECT_NEAR(v_down, 0.4, 1e-12);
}

TEST(DescentTest, BeginsWithWhatTheVehicleDoesAndNeverGoesUp) {
  for (const double before : {-5.0, 0.0, 0.2, 3.0}) {
    Descent descent;
    StateEstimate estimate;
    estimate.v_NB_B.z() = before;
    double last = std::max(before, 0.0);
    for (int i = 0; i < 300; ++i) {
      const double v_down = descent.sink(estimate, 0.4, 0.01, kBraking, kCatching);
      EXPECT_GE(v_down, 0.0);
      EXPECT_LE(v_down - last, kBraking * 0.01 + 1e-12);
      EXPECT_GE(v_down - last, -kCatching * 0.01 - 1e-12);
      last = v_down;
    }
    EXPECT_NEAR(last, 0.4, 1e-12);
  }
}

}  // namespace
}  // namespace ironbird::autopilot
