#include "autopilot/estimator/estimator.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "autopilot/estimator/external_pose_estimator.hpp"
#include "autopilot/handover.hpp"
#include "autopilot/math/euler_zyx.hpp"

namespace ironbird::autopilot {
namespace {

using std::chrono::milliseconds;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRoundOff = 1.0e-12;

/// Remembers what it was given; answers what it is told to.
class Listener final : public Estimator {
 public:
  void reset() override { Estimator::reset(); }
  int works = 0;
  SensorFrame heard;
  double dt = -1.0;
  double answer = 1.0;
  bool was_away = false;

 protected:
  StateEstimate estimate(const SensorFrame& frame, double step) override {
    ++works;
    was_away = imu_was_away();
    heard = frame;
    dt = step;
    StateEstimate x;
    x.stamp = frame.imu.stamp;
    x.p_NB_N.x() = answer;
    x.health = Health::kGood;
    return x;
  }
};

SensorFrame frame_at(int ms, double f_z = -9.81) {
  SensorFrame frame;
  frame.imu.stamp = milliseconds(ms);
  frame.imu.f_B = {0.0, 0.0, f_z};
  return frame;
}

TEST(EstimatorTest, FindsTheStepFromIntegerStamps) {
  Listener listener;
  listener.run(frame_at(100));
  EXPECT_EQ(listener.dt, 0.0);
  listener.run(frame_at(107));
  EXPECT_NEAR(listener.dt, 0.007, kRoundOff);
}

TEST(EstimatorTest, CountsJumpsOfThePositionAndSaysHowFar) {
  Listener listener;
  EXPECT_EQ(listener.run(frame_at(100)).position_resets, 0U) << "the first is no jump";
  listener.answer = 1.9;
  EXPECT_EQ(listener.run(frame_at(105)).position_resets, 0U) << "a small correction neither";
  listener.answer = 14.0;
  EXPECT_EQ(listener.run(frame_at(110)).position_resets, 1U);
  const StateEstimate& last = listener.run(frame_at(115));
  EXPECT_EQ(last.position_resets, 1U);
  EXPECT_NEAR(last.position_reset_sum_N.x(), 12.1, kRoundOff);
}

TEST(EstimatorTest, CountsTheJumpFromTheEstimateOfItsPredecessor) {
  Signals signals;
  signals.estimate.health = Health::kGood;
  signals.estimate.stamp = milliseconds(95);
  signals.estimate.position_resets = 4;
  signals.estimate.p_NB_N.x() = 30.0;
  Listener listener;
  listener.take_over(signals);
  const StateEstimate& first = listener.run(frame_at(100));
  EXPECT_EQ(first.position_resets, 5U);
  EXPECT_NEAR(first.position_reset_sum_N.x(), -29.0, kRoundOff);
}

TEST(EstimatorTest, TakesTheTurnToDieAwayWhileTheImuSendsNoNumbers) {
  Listener listener;
  for (int ms = 100; ms <= 200; ms += 5) {
    SensorFrame frame = frame_at(ms);
    frame.imu.w_NB_B.x() = ms < 200 ? 1.0 : 1.2;  // shaken at last
    listener.run(frame);
  }
  double before = 1.06;
  for (int ms = 205; ms <= 400; ms += 5) {
    SensorFrame frame = frame_at(ms);
    frame.imu.w_NB_B.x() = kNan;
    listener.run(frame);
    EXPECT_LT(listener.heard.imu.w_NB_B.x(), before);
    EXPECT_NEAR(listener.heard.imu.f_B.z(), -9.81, kRoundOff);
    before = listener.heard.imu.w_NB_B.x();
  }
  EXPECT_LT(before, 0.05);
  SensorFrame frame = frame_at(405);
  frame.imu.w_NB_B.x() = kNan;
  const StateEstimate& lost = listener.run(frame);
  EXPECT_EQ(lost.health, Health::kLost);
  EXPECT_GT(lost.sigma_attitude.minCoeff(), 3.0) << "rad: nothing follows how it turns";
}

TEST(EstimatorTest, RefusesAnOlderFrameAndCountsIt) {
  Listener listener;
  listener.run(frame_at(100));
  listener.run(frame_at(99));
  EXPECT_EQ(listener.works, 1);
  EXPECT_EQ(listener.refused_frames(), 1);
}

TEST(EstimatorTest, HoldsTheImuAndSaysDegradedWhenASampleIsNotFinite) {
  Listener listener;
  listener.run(frame_at(0, -9.0));
  const StateEstimate& x = listener.run(frame_at(5, kNan));
  EXPECT_EQ(listener.heard.imu.f_B.z(), -9.0);
  EXPECT_EQ(listener.heard.imu.stamp, Time(milliseconds(5)));
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_EQ(listener.run(frame_at(10)).health, Health::kGood);
}

/// Gives a frame every 5 ms from one stamp to the other, both inclusive.
const StateEstimate& run_through(Estimator& estimator, int from_ms, int to_ms, double f_z = -9.81) {
  for (int ms = from_ms; ms < to_ms; ms += 5) estimator.run(frame_at(ms, f_z));
  return estimator.run(frame_at(to_ms, f_z));
}

TEST(EstimatorTest, SaysLostWhenTheImuIsHeldForTooLong) {
  Listener listener;
  run_through(listener, 0, 100);
  EXPECT_EQ(run_through(listener, 105, 300, kNan).health, Health::kDegraded);
  EXPECT_EQ(run_through(listener, 305, 310, kNan).health, Health::kLost);
  EXPECT_EQ(run_through(listener, 315, 320).health, Health::kGood);
}

TEST(EstimatorTest, TellsItsFilterThatTheImuWasAway) {
  Listener listener;
  run_through(listener, 0, 100);
  EXPECT_FALSE(listener.was_away);
  run_through(listener, 105, 700, kNan);
  listener.run(frame_at(705));
  EXPECT_TRUE(listener.was_away);
  listener.run(frame_at(710));
  EXPECT_FALSE(listener.was_away);
}

TEST(EstimatorTest, TakesNoNoticeOfOneWildStamp) {
  Listener listener;
  run_through(listener, 0, 100);
  constexpr int kOneHour = 3600 * 1000;
  EXPECT_EQ(listener.run(frame_at(kOneHour)).health, Health::kGood);
  listener.run(frame_at(105));
  EXPECT_EQ(listener.heard.imu.stamp, Time(milliseconds(105)));
  EXPECT_EQ(listener.refused_frames(), 1);
}

TEST(EstimatorTest, GoesOnAfterAClockThatHasJumpedAhead) {
  Listener listener;
  run_through(listener, 0, 100);
  run_through(listener, 9000, 9005);
  EXPECT_TRUE(listener.was_away);
  EXPECT_EQ(listener.heard.imu.stamp, Time(milliseconds(9005)));
}

TEST(EstimatorTest, GoesOnInItsOwnTimeWhenTheSendersClockBeginsAnew) {
  Listener listener;
  const Time before = run_through(listener, 5000, 6000).stamp;
  const int works = listener.works;
  EXPECT_EQ(run_through(listener, 0, 45).stamp, before) << "they may be stragglers";
  SensorFrame frame = frame_at(50);
  frame.mag = MagSample{.stamp = milliseconds(50), .m_B = Vector3::UnitX()};
  const StateEstimate& x = listener.run(frame);
  EXPECT_EQ(listener.works, works + 1);
  EXPECT_TRUE(listener.was_away);
  EXPECT_GT(x.stamp, before + std::chrono::seconds(1)) << "nothing from before is fresh";
  EXPECT_EQ(listener.heard.mag->stamp, x.stamp);
  const Time then = x.stamp;
  EXPECT_EQ(listener.run(frame_at(55)).stamp, then + milliseconds(5));
}

TEST(EstimatorTest, SaysLostWhenNoStampsAgree) {
  Listener listener;
  run_through(listener, 5000, 6000);
  for (int i = 0; i < 20; ++i) listener.run(frame_at(4000 - 50 * (i % 7)));
  EXPECT_EQ(listener.run(frame_at(3000)).health, Health::kLost);
}

TEST(EstimatorTest, CountsAFixOnlyOnce) {
  Listener listener;
  SensorFrame frame = frame_at(0);
  frame.gnss = GnssSample{.stamp = milliseconds(1)};
  listener.run(frame);
  EXPECT_TRUE(listener.heard.gnss.has_value());
  frame.imu.stamp = milliseconds(5);
  listener.run(frame);
  EXPECT_FALSE(listener.heard.gnss.has_value());
  EXPECT_EQ(listener.dropped_samples(), 1);
  frame.gnss->stamp = milliseconds(2);
  frame.imu.stamp = milliseconds(10);
  listener.run(frame);
  EXPECT_TRUE(listener.heard.gnss.has_value());
}

TEST(EstimatorTest, WaitsForTheFirstSoundImuSample) {
  Listener listener;
  EXPECT_EQ(listener.run(frame_at(0, kNan)).health, Health::kUninitialised);
  EXPECT_EQ(listener.works, 0);
}

TEST(EstimatorTest, DropsSlowSamplesThatAreNotFiniteOrAbsurd) {
  Listener listener;
  SensorFrame frame = frame_at(0);
  frame.mag = MagSample{.m_B = {kNan, 0.0, 1.0}};
  frame.baro = BaroSample{.pressure = -3.0};
  frame.gnss = GnssSample{.latitude = kNan};
  frame.external_pose = ExternalPose{.p_NB_N = {0.0, kNan, 0.0}};
  listener.run(frame);
  EXPECT_FALSE(listener.heard.mag || listener.heard.baro || listener.heard.gnss ||
               listener.heard.external_pose);
  EXPECT_EQ(listener.dropped_samples(), 4);
}

TEST(EstimatorTest, KeepsTheLastFiniteEstimateMarkedLost) {
  Listener listener;
  listener.answer = 7.0;
  listener.run(frame_at(0));
  listener.answer = kNan;
  const StateEstimate& x = listener.run(frame_at(5));
  EXPECT_EQ(x.p_NB_N.x(), 7.0);
  EXPECT_EQ(x.health, Health::kLost);
  EXPECT_EQ(x.stamp, Time(milliseconds(5)));
  EXPECT_EQ(listener.non_finite_estimates(), 1);
}

TEST(EstimatorTest, LosesNoSlowSampleBetweenTwoWorks) {
  Listener listener;
  listener.set_period(milliseconds(10));
  listener.run(frame_at(0, -9.0));
  SensorFrame between = frame_at(5, -8.0);
  between.baro = BaroSample{.pressure = 90000.0};
  listener.run(between);
  EXPECT_EQ(listener.works, 1);
  listener.run(frame_at(10, -10.0));
  EXPECT_EQ(listener.works, 2);
  ASSERT_TRUE(listener.heard.baro.has_value());
  EXPECT_EQ(listener.heard.baro->pressure, 90000.0);
  EXPECT_NEAR(listener.heard.imu.f_B.z(), -9.0, kRoundOff)
      << "the mean of the two samples since the last work";
  listener.run(frame_at(20));
  EXPECT_FALSE(listener.heard.baro.has_value()) << "given only once";
}

TEST(ExternalPoseTest, PassesThePoseOn) {
  ExternalPoseEstimator estimator;
  EXPECT_EQ(estimator.run(frame_at(0)).health, Health::kUninitialised);
  SensorFrame frame = frame_at(5);
  frame.imu.w_NB_B = {0.1, 0.2, 0.3};
  const Vector3 theta(0.1, -0.2, 2.0);
  frame.external_pose = ExternalPose{.stamp = milliseconds(5),
                                     .p_NB_N = {1.0, 2.0, -3.0},
                                     .q_NB = quaternion_NB(theta),
                                     .v_NB_N = {4.0, 0.0, 1.0}};
  const StateEstimate& x = estimator.run(frame);
  EXPECT_EQ(x.health, Health::kGood);
  EXPECT_EQ(x.p_NB_N, Vector3(1.0, 2.0, -3.0));
  EXPECT_LT((x.v_NB_N() - Vector3(4.0, 0.0, 1.0)).norm(), kRoundOff);
  EXPECT_LT((Vector3(x.roll, x.pitch, x.heading) - theta).norm(), kRoundOff);
  EXPECT_EQ(x.w_NB_B, Vector3(0.1, 0.2, 0.3));
}

TEST(ExternalPoseTest, CarriesALatePoseToThePresent) {
  ExternalPoseEstimator estimator;
  SensorFrame frame = frame_at(100);
  frame.imu.w_NB_B = {0.0, 0.0, 1.0};
  frame.external_pose = ExternalPose{.stamp = milliseconds(50), .v_NB_N = {2.0, 0.0, 0.0}};
  const StateEstimate& x = estimator.run(frame);
  EXPECT_NEAR(x.p_NB_N.x(), 0.1, kRoundOff);
  EXPECT_NEAR(x.heading, 0.05, kRoundOff);
}

TEST(ExternalPoseTest, SaysLostWhenThePoseIsVeryOld) {
  ExternalPoseEstimator estimator;
  SensorFrame frame = frame_at(0);
  frame.external_pose = ExternalPose{};
  estimator.run(frame);
  EXPECT_EQ(run_through(estimator, 5, 900).health, Health::kDegraded);
  EXPECT_EQ(run_through(estimator, 905, 1100).health, Health::kLost);
}

TEST(ExternalPoseTest, SaysDegradedWhenThePoseIsOld) {
  ExternalPoseEstimator estimator;
  SensorFrame frame = frame_at(0);
  frame.external_pose = ExternalPose{};
  estimator.run(frame);
  EXPECT_EQ(run_through(estimator, 5, 1000).health, Health::kDegraded);
}

}  // namespace
}  // namespace ironbird::autopilot
