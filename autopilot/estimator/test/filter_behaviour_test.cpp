#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "autopilot/estimator/ekf.hpp"
#include "autopilot/estimator/error_state_filter.hpp"
#include "autopilot/estimator/test/fake_flight.hpp"
#include "autopilot/estimator/test/filter_fixture.hpp"
#include "autopilot/handover.hpp"
#include "autopilot/math/angles.hpp"

namespace ironbird::autopilot {
namespace {

TEST_P(FilterTest, FindsItsStartAtRestBeforeArming) {
  // GIVEN a vehicle at rest, never armed, with a gyro bias
  sensors.errors.gyro_bias = {0.02, -0.01, 0.015};
  // WHEN it has stood for three seconds
  fly(3.0);
  // THEN attitude, bias and origin are known
  EXPECT_EQ(x.health, Health::kGood);
  EXPECT_TRUE(x.origin.known);
  EXPECT_NEAR(x.origin.latitude, sensors.latitude, 1.0e-7);
  EXPECT_LT((x.gyro_bias_B - sensors.errors.gyro_bias).norm(), 1.0e-3);
  EXPECT_LT(angle_error(), kGoodAngle);
}

TEST_P(FilterTest, WaitsForTheCalibrationOfTheInertialUnit) {
  // GIVEN an FCU whose offsets are still to be found
  sensors.path.rest = 10.0;
  sensors.errors.accelerometer_bias = {0.0, 0.0, 0.3};
  SensorFrame frame = sensors.next();
  frame.status = FcuStatus{};
  frame.status->imu_calibrated = false;
  step(frame);
  fly(4.0);
  EXPECT_EQ(x.health, Health::kUninitialised);
  // WHEN they are found, and the readings step
  sensors.errors.accelerometer_bias.setZero();
  frame = sensors.next();
  frame.status = FcuStatus{};
  step(frame);
  fly(2.0);
  // THEN the filter has begun, and nothing of the old offset is left
  EXPECT_EQ(x.health, Health::kGood);
  constexpr double kNoise = 0.05;  // m/s^2, of the mean over a second
  EXPECT_NEAR(probed_vector("accelerometer_offset").z(), 0.0, kNoise);
}

TEST_P(FilterTest, FollowsAFlight) {
  sensors.errors.gnss = 0.05;
  fly(60.0);
  expect_good();
  EXPECT_EQ(probed("recoveries"), 0.0);
  EXPECT_EQ(probed("resets"), 0.0);
}

TEST_P(FilterTest, SaysNothingBeforeItHasHeardEverySensor) {
  sensors.gnss_on = false;
  fly(8.0);
  EXPECT_EQ(x.health, Health::kUninitialised);
  sensors.gnss_on = true;
  fly(3.0);
  EXPECT_NE(x.health, Health::kUninitialised);
}

TEST_P(FilterTest, CoastsThroughAGnssDropout) {
  // GIVEN a good estimate
  fly(40.0);
  expect_good();
  // WHEN the receiver is silent for ten seconds
  sensors.gnss_on = false;
  fly(10.0);
  // THEN the estimate is degraded and still near: a tilt error of 2 mrad for 10 s gives 1 m
  EXPECT_EQ(x.health, Health::kDegraded);
  EXPECT_LT(horizontal_error(), 4.0);
  EXPECT_LT(horizontal_error(), 4.0 * x.sigma_p_N.head<2>().norm() + 0.5);
  // AND good again soon after it is back
  sensors.gnss_on = true;
  fly(10.0);
  expect_good();
}

TEST_P(FilterTest, DegradesWhenCompassOrBarometerAreSilent) {
  fly(20.0);
  sensors.mag_on = false;
  fly(2.0);
  EXPECT_EQ(x.health, Health::kDegraded);
  sensors.mag_on = true;
  sensors.baro_on = false;
  fly(2.0);
  EXPECT_EQ(x.health, Health::kDegraded);
  sensors.baro_on = true;
  fly(2.0);
  expect_good();
}

TEST_P(FilterTest, IsNotMovedByAShortGnssJump) {
  fly(40.0);
  sensors.gnss_jump = {0.0, -60.0, 0.0};
  fly(1.0);
  sensors.gnss_jump.setZero();
  fly(2.0);
  expect_good();
}

TEST_P(FilterTest, SurvivesNotANumberInEachSensor) {
  fly(20.0);
  for (int sensor = 0; sensor < 5; ++sensor) {
    const double end = sensors.time() + 0.5;
    while (sensors.time() < end) {
      SensorFrame frame = sensors.next();
      if (sensor == 0) frame.imu.f_B.x() = kNan;
      if (sensor == 1) frame.imu.w_NB_B.z() = std::numeric_limits<double>::infinity();
      if (sensor == 2 && frame.mag) frame.mag->m_B.y() = kNan;
      if (sensor == 3 && frame.baro) frame.baro->pressure = kNan;
      if (sensor == 4 && frame.gnss) frame.gnss->v_NB_N.x() = kNan;
      step(frame);
    }
    EXPECT_NE(x.health, Health::kUninitialised);
    fly(8.0);
  }
  expect_good();
}

TEST_P(FilterTest, StartsInTheAir) {
  // GIVEN a vehicle that is already moving when the filter starts
  sensors.path.rest = -20.0;
  // WHEN it has heard its sensors for a while
  fly(20.0);
  // THEN velocity and attitude are right, and position follows from the first fix
  EXPECT_EQ(x.health, Health::kGood);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
  EXPECT_LT(angle_error(), 2.0 * kGoodAngle);
}

TEST_P(FilterTest, ComparesALateFixWithItsOwnTime) {
  // GIVEN fixes that arrive 0.15 s late
  sensors.errors.latency = 0.15;
  sensors.errors.gnss = 0.02;
  double with = 0.0;
  double without = 0.0;
  for (const bool compensated : {true, false}) {
    AidingParams aiding;
    aiding.gnss.latency_compensation = compensated;
    aiding.gnss.sigma_horizontal = 0.05;
    sensors = FakeSensors(7);
    sensors.errors.latency = 0.15;
    sensors.errors.gnss = 0.02;
    make(aiding, false);
    fly(30.0);
    double& sum = compensated ? with : without;
    for (int i = 0; i < 8000; ++i) {
      step(sensors.next());
      sum += std::pow(horizontal_error(), 2) / 8000.0;
    }
  }
  // THEN the error is that of the receiver, not speed times latency (3.5 m/s x 0.15 s)
  EXPECT_LT(std::sqrt(with), 0.1);
  EXPECT_GT(std::sqrt(without), 3.0 * std::sqrt(with));
}

TEST_P(FilterTest, FindsBackAfterNonsenseFromTheImu) {
  fly(30.0);
  // WHEN the IMU says for a tenth of a second what no vehicle can do but a wire can carry
  const double end = sensors.time() + 0.1;
  while (sensors.time() < end) {
    SensorFrame frame = sensors.next();
    frame.imu.f_B.setConstant(500.0);
    frame.imu.w_NB_B.setConstant(50.0);
    step(frame);
  }
  EXPECT_GT(angle_error(), 0.5);
  // THEN nothing is ever not finite (checked in every step) and the filter finds its attitude again
  fly(40.0);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
  EXPECT_LT(angle_error(), 2.0 * kGoodAngle);
  EXPECT_LT(horizontal_error(), 2.0 * kGoodPosition);
}

TEST_P(FilterTest, GoesOnFromTheEstimateOfItsPredecessor) {
  // GIVEN a good estimate of one filter
  fly(30.0);
  Signals signals;
  signals.estimate = x;
  // WHEN another one takes over
  make(AidingParams{}, true);
  estimator->take_over(signals);
  step(sensors.next());
  // THEN it has it at once, and keeps it
  EXPECT_LT(position_error(), kGoodPosition);
  EXPECT_NE(x.health, Health::kUninitialised);
  fly(20.0);
  expect_good();
}

TEST_P(FilterTest, IsLostWithoutSatellitesAndBarometer) {
  fly(20.0);
  sensors.gnss_on = sensors.baro_on = false;
  fly(14.5);
  EXPECT_EQ(x.health, Health::kDegraded);
  fly(1.0);
  EXPECT_EQ(x.health, Health::kLost) << "nothing has measured the height for 15 s";
}

TEST_P(FilterTest, WorksAtHalfTheRateOfTheImu) {
  estimator->set_period(std::chrono::milliseconds(5));
  fly(60.0);
  expect_good();
}

TEST_P(FilterTest, GivesTheSameBytesAfterAReset) {
  fly(20.0);
  const StateEstimate first = x;
  sensors = FakeSensors(7);
  estimator->reset();
  fly(20.0);
  EXPECT_EQ(first.p_NB_N, x.p_NB_N);
  EXPECT_EQ(first.v_NB_B, x.v_NB_B);
  EXPECT_EQ(first.q_NB.coeffs(), x.q_NB.coeffs());
}

TEST_P(FilterTest, IsLessSureOfItsAttitudeWhenItIsShakenAndToldWhatThatDoes) {
  const auto tilt_sigma = [this](double gyro_per_vibration) {
    make(AidingParams{}, true);
    if (auto* const ekf = dynamic_cast<Ekf*>(estimator.get())) {
      EkfParams params = ekf->params();
      params.noise.gyro_per_vibration = gyro_per_vibration;
      ekf->set_params(params);
    } else {
      auto& filter = dynamic_cast<ErrorStateFilter&>(*estimator);
      ErrorStateParams params = filter.params();
      params.noise.gyro_per_vibration = gyro_per_vibration;
      filter.set_params(params);
    }
    sensors = FakeSensors(5);
    sensors.errors.accelerometer = 2.0;
    fly(12.0);
    return x.sigma_attitude.x();
  };
  EXPECT_GT(tilt_sigma(0.005), 1.5 * tilt_sigma(0.0));
}

// What a compass says on a field with iron in it, real flights say, is up to 20 degrees wrong.
TEST_P(FilterTest, SeeksTheHeadingAnewAboveTheGroundsIron) {
  const auto fly_from_iron = [this](double ground_sigma) {
    AidingParams aiding;
    aiding.mag.ground_sigma = ground_sigma;
    make(aiding, false);
    sensors = FakeSensors(5);
    sensors.path.pace = 0.25;  // so little acceleration that the fixes say nothing of the heading
    sensors.errors.compass = 0.35;
    while (sensors.truth().p_N.z() > -aiding.mag.ground_height) step(armed(sensors.next()));
    sensors.errors.compass = 0.0;
    const double end = sensors.time() + 1.0;
    while (sensors.time() < end) step(armed(sensors.next()));
    return std::abs(shortest_difference(x.heading, sensors.truth().theta.z()));
  };
  const double without = fly_from_iron(0.0);
  EXPECT_GT(without, 0.2);
  EXPECT_LT(fly_from_iron(0.5), 0.25 * without);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed) << "the velocity over ground does not turn with the heading";
  EXPECT_EQ(x.health, Health::kGood);
}

INSTANTIATE_TEST_SUITE_P(Filters, FilterTest, ::testing::Values(Kind::kEkf, Kind::kErrorState),
                         [](const auto& case_) { return case_.param == Kind::kEkf ? "Ekf" : "ErrorState"; });

/// Largest difference of P from its transpose, and its least eigenvalue after scaling to unit diagonal.
void expect_symmetric_positive(const Eigen::MatrixXd& P) {
  EXPECT_EQ((P - P.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * P * scale.asDiagonal();
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues().minCoeff(), 0.0);
}

TEST(EkfTest, KeepsItsCovarianceSymmetricAndPositive) {
  FakeSensors sensors(3);
  Ekf filter;
  while (sensors.time() < 120.0) filter.run(sensors.next());
  expect_symmetric_positive(filter.covariance());
}

/// How many velocities the filter refuses in a minute with a gyro whose axes are turned by 0.1 rad about Bx.
double refused_with_a_gyro_askew(double gyro_per_rate) {
  FakeSensors sensors(3);
  sensors.errors.gnss_velocity = 0.05;
  sensors.path.pace = 2.0;
  EkfParams params;
  params.noise.velocity = params.noise.velocity_down = 1.0e-4;
  params.noise.gyro_per_rate = gyro_per_rate;
  params.aiding.mag.declination = sensors.declination;
  Ekf filter;
  filter.set_params(params);
  while (sensors.time() < 60.0) {
    SensorFrame frame = sensors.next();
    frame.imu.w_NB_B += Vector3(0.1, 0.0, 0.0).cross(frame.imu.w_NB_B);
    filter.run(frame);
  }
  return probed(filter, "rejected_velocity");
}

TEST(EkfTest, BelievesDopplerWhileAGyroThatIsAskewTurns) {
  EXPECT_GT(refused_with_a_gyro_askew(0.0), 0.0);
  constexpr double kAskewForASecond = 0.1;  // sqrt(s), 0.1 rad sqrt(1 s)
  EXPECT_EQ(refused_with_a_gyro_askew(kAskewForASecond), 0.0);
}

TEST(ErrorStateFilterTest, KeepsItsCovarianceSymmetricAndPositive) {
  FakeSensors sensors(3);
  ErrorStateFilter filter;
  while (sensors.time() < 120.0) filter.run(sensors.next());
  expect_symmetric_positive(filter.covariance());
}

TEST(ErrorStateFilterTest, FindsTheBiasOfTheAccelerometer) {
  FakeSensors sensors(3);
  sensors.errors.accelerometer_bias = {0.05, -0.04, 0.03};
  ErrorStateFilter filter;
  ErrorStateParams params;
  params.aiding.mag.declination = sensors.declination;
  filter.set_params(params);
  StateEstimate x;
  while (sensors.time() < 120.0) x = filter.run(sensors.next());
  EXPECT_LT((x.accelerometer_bias_B - sensors.errors.accelerometer_bias).norm(), 0.02);
}

}  // namespace
}  // namespace ironbird::autopilot
