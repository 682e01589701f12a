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
#include "autopilot/math/angles.hpp"
#include "autopilot/signals.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What both filters must do, on the default parameters and the noise of FakeErrors.
constexpr double kGoodPosition = 1.0;  // m, receiver with 0.05 m white error and a slow one of none
constexpr double kGoodSpeed = 0.15;    // m/s, ten times the Doppler noise
constexpr double kGoodAngle = 0.03;    // rad

enum class Kind { kEkf, kErrorState };

class FilterTest : public ::testing::TestWithParam<Kind> {
 protected:
  FilterTest() { make(AidingParams{}, true); }

  /// @param plain  the kind's own defaults, only the declination set
  void make(const AidingParams& aiding, bool plain) {
    if (GetParam() == Kind::kEkf) {
      auto filter = std::make_unique<Ekf>();
      EkfParams params;
      if (!plain) params.aiding = aiding;
      params.aiding.mag.declination = sensors.declination;
      filter->set_params(params);
      estimator = std::move(filter);
    } else {
      auto filter = std::make_unique<ErrorStateFilter>();
      ErrorStateParams params;
      if (!plain) params.aiding = aiding;
      params.aiding.mag.declination = sensors.declination;
      filter->set_params(params);
      estimator = std::move(filter);
    }
  }

  void fly(double seconds) {
    const double end = sensors.time() + seconds;
    while (sensors.time() < end) step(sensors.next());
  }

  void step(const SensorFrame& frame) {
    x = estimator->run(frame);
    ASSERT_TRUE(x.p_NB_N.allFinite() && x.v_NB_B.allFinite() && x.q_NB.coeffs().allFinite());
  }

  double position_error() const { return (x.p_NB_N - sensors.truth().p_N).norm(); }
  double horizontal_error() const { return (x.p_NB_N - sensors.truth().p_N).head<2>().norm(); }
  double speed_error() const { return (x.v_NB_N() - sensors.truth().v_N).norm(); }
  double angle_error() const { return x.q_NB.angularDistance(Quaternion(sensors.truth().R_NB)); }

  void expect_good() const {
    EXPECT_EQ(x.health, Health::kGood);
    EXPECT_LT(position_error(), kGoodPosition);
    EXPECT_LT(speed_error(), kGoodSpeed);
    EXPECT_LT(angle_error(), kGoodAngle);
  }

  double probed(const std::string& wanted) const {
    struct Finder final : ProbeVisitor {
      std::string wanted;
      double found = kNan;
      void operator()(std::string_view name, double value, std::string_view) override {
        if (name == wanted) found = value;
      }
      void operator()(std::string_view, const Vector3&, std::string_view) override {}
    } finder;
    finder.wanted = wanted;
    estimator->probe(finder);
    return finder.found;
  }

  Vector3 probed_vector(const std::string& wanted) const {
    struct Finder final : ProbeVisitor {
      std::string wanted;
      Vector3 found = Vector3::Constant(kNan);
      void operator()(std::string_view, double, std::string_view) override {}
      void operator()(std::string_view name, const Vector3& value, std::string_view) override {
        if (name == wanted) found = value;
      }
    } finder;
    finder.wanted = wanted;
    estimator->probe(finder);
    return finder.found;
  }

  FakeSensors sensors{7};
  std::unique_ptr<AidedEstimator> estimator;
  StateEstimate x;
};

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

TEST_P(FilterTest, RefusesAGnssJumpThenBelievesItWhenItPersists) {
  // GIVEN a good estimate
  fly(40.0);
  // WHEN all fixes jump by 100 m
  sensors.gnss_jump = {100.0, 0.0, 0.0};
  fly(1.5);
  // THEN they are refused at first
  EXPECT_LT(horizontal_error(), kGoodPosition);
  EXPECT_EQ(x.health, Health::kDegraded);
  // AND believed when they insist
  fly(6.0);
  EXPECT_NEAR(x.p_NB_N.x() - sensors.truth().p_N.x(), 100.0, 2.0);
  EXPECT_EQ(x.health, Health::kGood);
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

TEST_P(FilterTest, BridgesAGapInTheImu) {
  fly(30.0);
  for (int i = 0; i < 100; ++i) sensors.next();  // 0.25 s lost
  step(sensors.next());
  EXPECT_EQ(x.health, Health::kDegraded);
  fly(5.0);
  EXPECT_LT(speed_error(), 2.0 * kGoodSpeed);
  EXPECT_LT(position_error(), kGoodPosition);
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

TEST_P(FilterTest, IsLostWithoutSatellitesAndBarometer) {
  fly(20.0);
  sensors.gnss_on = sensors.baro_on = false;
  fly(14.5);
  EXPECT_EQ(x.health, Health::kDegraded);
  fly(1.0);
  EXPECT_EQ(x.health, Health::kLost) << "nothing has measured the height for 15 s";
}

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

INSTANTIATE_TEST_SUITE_P(Filters, FilterTest, ::testing::Values(Kind::kEkf, Kind::kErrorState),
                         [](const auto& case_) { return case_.param == Kind::kEkf ? "Ekf" : "ErrorState"; });

/// Largest difference of P from its transpose, and its least eigenvalue after scaling to unit diagonal.
template <class Matrix>
void expect_symmetric_positive(const Matrix& P) {
  EXPECT_EQ((P - P.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Matrix scale = P.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
  const Matrix correlation = scale * P * scale;
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix>(correlation).eigenvalues().minCoeff(), 0.0);
}

TEST(EkfTest, KeepsItsCovarianceSymmetricAndPositive) {
  FakeSensors sensors(3);
  Ekf filter;
  while (sensors.time() < 120.0) filter.run(sensors.next());
  expect_symmetric_positive(filter.covariance());
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
