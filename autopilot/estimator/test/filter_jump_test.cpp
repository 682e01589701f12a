#include <gtest/gtest.h>

#include "autopilot/estimator/test/filter_fixture.hpp"
#include "autopilot/handover.hpp"

// What the filters make of satellite fixes that jump. Instantiated in filter_behaviour_test.cpp.

namespace ironbird::autopilot {
namespace {

constexpr double kFixError = 0.2;  // m, of the step that a filter finds

TEST_P(FilterTest, RefusesAJumpThatDopplerContradictsAndSaysThatItDoubts) {
  // GIVEN a good estimate in flight
  fly_armed();
  // WHEN all fixes jump by 300 m
  sensors.gnss_jump = {300.0, 0.0, 0.0};
  fly(1.5);
  // THEN they are refused at first
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_FALSE(x.position_doubtful);
  // AND for good, with doubt, when they insist
  fly(kPersistence);
  EXPECT_TRUE(x.position_doubtful);
  EXPECT_TRUE(x.position_known) << "by dead reckoning";
  EXPECT_LT((x.position_offset_N - sensors.gnss_jump).norm(), kFixError);
  fly(60.0);
  EXPECT_TRUE(x.position_doubtful);
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_LT(horizontal_error(), kGoodPosition);
  EXPECT_EQ(x.position_resets, 0U);
}

TEST_P(FilterTest, BelievesAReceiverThatJumpsBack) {
  fly_armed();
  sensors.gnss_jump = {0.0, -25.0, 0.0};
  fly(kPersistence);
  EXPECT_TRUE(x.position_doubtful);
  sensors.gnss_jump.setZero();
  fly(1.0);
  EXPECT_TRUE(x.position_doubtful) << "one fix is not enough";
  fly(kPersistence);
  EXPECT_FALSE(x.position_doubtful);
  EXPECT_TRUE(x.position_offset_N.isZero(0.0));
  fly(1.0);
  expect_good();
}

TEST_P(FilterTest, GoesOnDoubtingAReceiverThatComesBackInPart) {
  fly_armed();
  sensors.gnss_jump = {60.0, 0.0, 0.0};
  fly(kPersistence);
  ASSERT_TRUE(x.position_doubtful);
  // WHEN it alternates between two wrong places, the one nearer to the right one than to the other
  for (const double north : {25.0, 60.0, 25.0}) {
    sensors.gnss_jump.x() = north;
    for (int i = 0; i < 50; ++i) {
      fly(0.1);
      ASSERT_TRUE(x.position_doubtful) << "after " << i / 10.0 << " s at " << north << " m";
    }
    EXPECT_LT((x.position_offset_N - sensors.gnss_jump).norm(), 2.0);
  }
  EXPECT_LT(horizontal_error(), kGoodPosition);
  EXPECT_EQ(x.position_resets, 0U);
}

TEST_P(FilterTest, IsSureLaterEachTimeTheFixesJumpAgain) {
  fly_armed();
  for (const bool first : {true, false}) {
    sensors.gnss_jump = {60.0, 0.0, 0.0};
    fly(5.0);
    ASSERT_TRUE(x.position_doubtful);
    sensors.gnss_jump.setZero();
    fly(5.0);
    EXPECT_EQ(x.position_doubtful, !first);
  }
  fly(2.0);
  EXPECT_FALSE(x.position_doubtful);
}

TEST_P(FilterTest, KeepsItsDoubtWhenItIsDisarmedUntilTheFixesComeBack) {
  fly_armed();
  sensors.gnss_jump = {300.0, 0.0, 0.0};
  fly(kPersistence);
  const double latitude = x.origin.latitude;
  SensorFrame frame = armed(sensors.next());
  frame.status->armed = false;
  step(frame);
  fly(5.0);
  EXPECT_TRUE(x.position_doubtful);
  EXPECT_EQ(x.origin.latitude, latitude) << "the launch stays where it was on the earth";
  sensors.gnss_jump.setZero();
  fly(kPersistence);
  EXPECT_FALSE(x.position_doubtful);
}

TEST_P(FilterTest, MovesItsOriginWhenTheFixesJumpOnTheGround) {
  sensors.path.rest = 1000.0;
  fly(10.0);
  const double latitude = x.origin.latitude;
  sensors.gnss_jump = {100.0, 0.0, 0.0};
  fly(kPersistence + 1.0);
  EXPECT_NEAR((x.origin.latitude - latitude) * 6378145.0, 100.0, kFixError);
  EXPECT_FALSE(x.position_doubtful);
  EXPECT_EQ(x.position_resets, 0U) << "N stays with the vehicle";
  expect_good();
}

TEST_P(FilterTest, SeesAJumpOfFixesThatWeighLittle) {
  AidingParams aiding;
  aiding.gnss.sigma_horizontal = 15.0;
  make(aiding, false);
  fly_armed();
  sensors.gnss_jump = {0.0, 12.0, 0.0};
  fly(kPersistence);
  EXPECT_TRUE(x.position_doubtful);
}

TEST_P(FilterTest, BelievesTheFixesAfterAPauseInWhichItMayHaveDrifted) {
  fly_armed();
  // GIVEN a pause, and fixes behind it that are as far off as a drift of 2.5 m/s
  jump_after_pause(10.0, 25.0);
  // THEN it is the filter that has gone astray, and says how far it is set back
  EXPECT_FALSE(x.position_doubtful);
  EXPECT_NEAR(x.p_NB_N.x() - sensors.truth().p_N.x(), 25.0, 2.0);
  EXPECT_GE(x.position_resets, 1U);
  EXPECT_GT(x.position_reset_sum_N.x(), 15.0);
  EXPECT_EQ(x.position_reset_sum_N.z(), 0.0);
}

TEST_P(FilterTest, FindsTheHeightAgainThatWalkedOffWithAWrongVelocity) {
  // GIVEN a barometer that is told to weigh as little as those of real vehicles do
  AidingParams aiding;
  aiding.baro.sigma = 100.0;
  make(aiding, false);
  fly_armed();
  // WHEN the accelerometer is wrong for a second, until the Doppler sets the velocity right
  sensors.errors.accelerometer_bias = {5.0, 5.0, -5.0};
  fly(1.0);
  sensors.errors.accelerometer_bias.setZero();
  fly(1.0);
  // 5 m/s^2 for a second and as fast for another make 7.5 m.
  ASSERT_GT(std::abs(x.p_NB_N.z() - sensors.truth().p_N.z()), 5.0);
  // THEN the barometer sets the height right, too: alone with its weight it would take minutes, 8 m are left
  fly(10.0);
  EXPECT_LT(std::abs(x.p_NB_N.z() - sensors.truth().p_N.z()), 1.0);
  EXPECT_LT(speed_error(), kGoodSpeed);
}

TEST_P(FilterTest, IsAsSureOfThePlaceItIsSetToAsTheGateIsOfAFix) {
  AidingParams aiding;
  aiding.gnss.sigma_horizontal = 15.0;
  make(aiding, false);
  fly_armed();
  jump_after_pause(10.0, 25.0);
  ASSERT_EQ(x.position_resets, 1U);
  EXPECT_NEAR(x.sigma_p_N.x(), aiding.gnss.gate_sigma, 0.1);
}

TEST_P(FilterTest, DoesNotTakeAFarJumpAfterAPauseForItsOwnDrift) {
  fly_armed();
  jump_after_pause(5.0, 300.0);
  EXPECT_TRUE(x.position_doubtful);
  EXPECT_LT(horizontal_error(), 4.0);
}

TEST_P(FilterTest, HandsItsDoubtOnToItsSuccessor) {
  fly_armed();
  sensors.gnss_jump = {300.0, 0.0, 0.0};
  fly(kPersistence);
  Signals signals;
  signals.flight.fcu.armed = true;
  signals.estimate = x;
  make(AidingParams{}, true);
  estimator->take_over(signals);
  fly(1.0);
  EXPECT_TRUE(x.position_doubtful);
  EXPECT_LT(horizontal_error(), kGoodPosition);
}

TEST_P(FilterTest, TakesASigmaOfHeightOnlyWhenItUsesTheHeightOfAFix) {
  ParameterTable table;
  estimator->register_parameters(table, "estimator");
  const bool uses_height = GetParam() == Kind::kErrorState;
  EXPECT_EQ(table.find("estimator.gnss.sigma_vertical") != nullptr, uses_height);
}

}  // namespace
}  // namespace ironbird::autopilot
