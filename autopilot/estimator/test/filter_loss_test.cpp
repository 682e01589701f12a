#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "autopilot/estimator/test/filter_fixture.hpp"
#include "autopilot/handover.hpp"

// What is left of an estimate when samples, stamps or a module go missing, and how it is found again.
// Instantiated in filter_behaviour_test.cpp.

namespace ironbird::autopilot {
namespace {

TEST_P(FilterTest, DoesNotTrustItsAttitudeAfterALongGapInTheImu) {
  fly(20.0);
  for (int i = 0; i < 2000; ++i) sensors.next();  // 5 s lost
  step(sensors.next());
  step(sensors.next());  // the first alone may have had a wild stamp
  EXPECT_EQ(x.health, Health::kLost);
  const InitialSigmaParams air;
  EXPECT_GT(x.sigma_attitude.head<2>().minCoeff(), 0.9 * air.air_tilt);
  EXPECT_GT(x.sigma_v_B.minCoeff(), 0.9 * air.air_velocity);
  fly(15.0);
  EXPECT_EQ(x.health, Health::kGood) << "it has sought its attitude anew";
  EXPECT_LT(angle_error(), 3.0 * kGoodAngle);
}

TEST_P(FilterTest, DoesNotFlyOnAnImuThatSendsNoNumbers) {
  fly(20.0);
  const double end = sensors.time() + 3.0;
  while (sensors.time() < end) {
    SensorFrame frame = sensors.next();
    frame.imu.w_NB_B.x() = kNan;
    step(frame);
    if (sensors.time() > end - 2.79) {
      EXPECT_EQ(x.health, Health::kLost);
    }
  }
  step(sensors.next());
  EXPECT_EQ(x.health, Health::kLost) << "the attitude is still unknown";
  fly(15.0);
  EXPECT_EQ(x.health, Health::kGood);
  EXPECT_LT(angle_error(), 3.0 * kGoodAngle);
}

TEST_P(FilterTest, FindsItselfAgainWhenTheSendersClockBeginsAnew) {
  fly(20.0);
  const Time before = x.stamp;
  const auto restarted = [&] {
    SensorFrame frame = sensors.next();
    const Time back = std::chrono::seconds(15);
    frame.imu.stamp -= back;
    if (frame.gnss) frame.gnss->stamp -= back;
    return frame;
  };
  for (int i = 0; i < 21; ++i) step(restarted());  // 50 ms, both ends counted
  EXPECT_EQ(x.health, Health::kLost);
  for (int i = 0; i < 6000; ++i) step(restarted());
  EXPECT_EQ(x.health, Health::kGood);
  EXPECT_GT(x.stamp, before);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
  EXPECT_LT(angle_error(), 3.0 * kGoodAngle);
}

TEST_P(FilterTest, KeepsTheVelocityOverGroundWhenItsHeadingIsReset) {
  fly(30.0);
  sensors.errors.compass = 0.6;
  const double before = probed("resets");
  Vector3 v_N = Vector3::Zero();
  while (probed("resets") == before && sensors.time() < 60.0) {
    v_N = x.v_NB_N();
    step(sensors.next());
  }
  ASSERT_GT(probed("resets"), before);
  ASSERT_GT(v_N.head<2>().norm(), 1.0) << "m/s, else a turn would not show";
  EXPECT_LT((x.v_NB_N() - v_N).norm(), 0.1);
  fly(0.15);
  EXPECT_LT(probed("nis_velocity"), GnssParams{}.velocity_gate);
}

TEST_P(FilterTest, LeavesOutACompassThatStepsAwayInFlight) {
  for (const double step : {0.6, -1.6, 3.0}) {
    // GIVEN a heading with which the compass has agreed
    sensors = FakeSensors(7);
    make(AidingParams{}, true);
    fly_armed();
    const double before = probed("resets");
    // WHEN the compass steps away, for much longer than its persistence
    sensors.errors.compass = step;
    fly(30.0);
    // THEN gyro and Doppler carry the heading, and the estimate says what is wrong
    EXPECT_EQ(x.health, Health::kDegraded) << step;
    EXPECT_EQ(probed("resets"), before) << step;
    EXPECT_LT(angle_error(), kGoodAngle) << step;
    EXPECT_LT(speed_error(), kGoodSpeed) << step;
    // AND the compass is heard again when it is back
    sensors.errors.compass = 0.0;
    fly(2.0);
    expect_good();
  }
}

TEST_P(FilterTest, LeavesOutACompassThatItGivesLittleWeight) {
  AidingParams aiding;
  aiding.mag.sigma_tilt = 1.0;  // without a sigma of its own the gate would let everything pass
  make(aiding, false);
  fly_armed();
  sensors.errors.compass = 1.5;
  fly(30.0);
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_LT(angle_error(), kGoodAngle);
}

TEST_P(FilterTest, BelievesTheCompassWhenDopplerContradictsTheHeadingToo) {
  fly_armed();
  // WHEN the gyro tells of a quarter of a turn that was none
  const double end = sensors.time() + 0.5;
  while (sensors.time() < end) {
    SensorFrame frame = sensors.next();
    frame.imu.w_NB_B += 3.0 * sensors.truth().R_NB.row(2).transpose();
    step(frame);
  }
  EXPECT_GT(angle_error(), 1.0);
  // THEN the heading is found again
  fly(40.0);
  EXPECT_LT(angle_error(), 2.0 * kGoodAngle);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
}

TEST_P(FilterTest, DoesNotFollowAPredecessorWithoutAnOriginInFlight) {
  Signals signals;
  signals.flight.phase = FlightPhase::kHold;
  signals.estimate.health = Health::kGood;  // poses from outside are good, and nowhere on the earth
  EXPECT_FALSE(estimator->objection(signals).empty());
  signals.estimate.origin.known = true;
  EXPECT_TRUE(estimator->objection(signals).empty());
  signals.estimate.health = Health::kUninitialised;
  EXPECT_FALSE(estimator->objection(signals).empty());
}

TEST_P(FilterTest, KeepsTheBiasOfTheAccelerometerOverAnExchange) {
  sensors.errors.accelerometer_bias = {0.0, 0.0, 0.3};
  fly(60.0);
  const Vector3 bias_B = x.accelerometer_bias_B;
  EXPECT_NEAR(bias_B.z(), 0.3, 0.1);
  Signals signals;
  signals.estimate = x;
  make(AidingParams{}, true);
  estimator->take_over(signals);
  step(sensors.next());
  EXPECT_LT((x.accelerometer_bias_B - bias_B).norm(), 0.01);
  double worst = 0.0;
  for (int i = 0; i < 1200; ++i) {
    step(sensors.next());
    worst = std::max(worst, std::abs(x.v_NB_N().z() - sensors.truth().v_N.z()));
  }
  EXPECT_LT(worst, 0.12) << "m/s";
}

struct WindowCase {
  const char* name;
  int fixes, baro_samples, baro_every;
};

TEST_P(FilterTest, AlignsWithAsManySamplesAsItMayBeAskedFor) {
  for (const WindowCase& wanted : {WindowCase{"fixes", 200, 50, 4}, WindowCase{"pressures", 5, 512, 8}}) {
    sensors = FakeSensors(7);
    sensors.path.rest = 1000.0;
    sensors.baro_every = wanted.baro_every;
    AidingParams aiding;
    aiding.alignment.fixes = wanted.fixes;
    aiding.alignment.baro_samples = wanted.baro_samples;
    make(aiding, false);
    fly(25.0);
    EXPECT_EQ(x.health, Health::kGood) << wanted.name;
  }
}

TEST_P(FilterTest, SaysThatThePositionIsNotKnownAfterALongGnssLoss) {
  fly(20.0);
  EXPECT_TRUE(x.position_known);
  EXPECT_LT(x.position_age, 0.2);
  sensors.gnss_on = false;
  fly(14.5);  // the default of gnss.coast is 15 s
  EXPECT_TRUE(x.position_known);
  fly(1.0);
  EXPECT_FALSE(x.position_known);
  EXPECT_EQ(x.health, Health::kDegraded) << "height and attitude are still good";
  fly(60.0);
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_NEAR(x.p_NB_N.z(), sensors.truth().p_N.z(), 2.0) << "m, on the barometer";
  sensors.gnss_on = true;
  fly(1.0);
  EXPECT_TRUE(x.position_known);
}

TEST_P(FilterTest, BridgesAGapInTheImu) {
  fly(30.0);
  for (int i = 0; i < 100; ++i) sensors.next();  // 0.25 s lost
  step(sensors.next());
  EXPECT_EQ(x.health, Health::kDegraded);
  fly(5.0);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
  EXPECT_LT(position_error(), kGoodPosition);
}

TEST_P(FilterTest, HandsOnForHowLongThePositionWasNotMeasured) {
  fly(20.0);
  sensors.gnss_on = false;
  fly(10.0);
  Signals signals;
  signals.estimate = x;
  make(AidingParams{}, true);
  estimator->take_over(signals);
  fly(4.0);
  EXPECT_NEAR(x.position_age, 14.0, 0.2);
  fly(1.5);
  EXPECT_FALSE(x.position_known) << "an exchange is no fix";
}

}  // namespace
}  // namespace ironbird::autopilot
