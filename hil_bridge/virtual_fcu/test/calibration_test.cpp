#include "hil_bridge/virtual_fcu/calibration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "hil_bridge/virtual_fcu/battery_monitor.hpp"
#include "hil_bridge/virtual_fcu/sensor_corrections.hpp"

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr float kSum = 1e-4F;  // a thousand float32 additions

TEST(GyroCalibrationTest, AveragesAThousandAndOneSamples) {
  GyroCalibration calibration;
  calibration.start();
  for (int k = 0; k < 1000; ++k) {
    ASSERT_FALSE(calibration.add({0.1F + (k % 2 == 0 ? 0.02F : -0.02F), -0.2F, 0.3F}));
  }
  const auto result = calibration.add({0.1F, -0.2F, 0.3F});
  ASSERT_TRUE(result);
  EXPECT_FALSE(calibration.running());
  EXPECT_EQ(result->verdict, BiasResult::Verdict::kAccepted);
  EXPECT_NEAR(result->bias.x, 0.1F, kSum);
  EXPECT_NEAR(result->bias.y, -0.2F, kSum);
  EXPECT_NEAR(result->bias.z, 0.3F, kSum);
}

TEST(GyroCalibrationTest, RefusesAMeanOfOneRadianPerSecond) {
  for (const float rate : {0.99F, 1.0F}) {
    GyroCalibration calibration;
    calibration.start();
    std::optional<BiasResult> result;
    while (!result) result = calibration.add({rate, 0, 0});
    EXPECT_EQ(result->verdict == BiasResult::Verdict::kAccepted, rate < 1.0F) << rate;
  }
}

struct AccelerationCase {
  const char* name;
  Triple steady;
  float shake;  // half the spread along x
  BiasResult::Verdict verdict;
};

TEST(AccelerometerCalibrationTest, JudgesSpreadThenBias) {
  using Verdict = BiasResult::Verdict;
  for (const AccelerationCase& c : {AccelerationCase{"still", {0.2F, -0.1F, -9.5F}, 0.1F, Verdict::kAccepted},
                                    AccelerationCase{"shaken", {0.2F, -0.1F, -9.5F}, 0.51F, Verdict::kMoved},
                                    AccelerationCase{"on its side", {0, -9.8F, 0}, 0.0F, Verdict::kTooLarge},
                                    AccelerationCase{"both", {0, -9.8F, 0}, 0.6F, Verdict::kMoved}}) {
    AccelerometerCalibration calibration;
    calibration.start();
    std::optional<BiasResult> result;
    for (int k = 0; !result; ++k) {
      const float shake = k % 2 == 0 ? c.shake : -c.shake;
      result = calibration.add({c.steady.x + shake, c.steady.y, c.steady.z}, 300.0F, {});
    }
    EXPECT_EQ(result->verdict, c.verdict) << c.name;
    if (c.verdict != Verdict::kAccepted) continue;
    EXPECT_NEAR(result->bias.x, 0.2F, 1e-3F);
    EXPECT_NEAR(result->bias.z, -9.5F + kGravity, 1e-3F);
  }
}

TEST(AccelerometerCalibrationTest, TakesTheTemperatureDriftOutOfTheBias) {
  AccelerometerCalibration calibration;
  calibration.start();
  std::optional<BiasResult> result;
  while (!result) result = calibration.add({0.5F, 0, -kGravity}, 300.0F, {0.001F, 0, 0});
  EXPECT_NEAR(result->bias.x, 0.5F - 0.3F, 1e-3F);
}

class PressureCalibrationTest : public ::testing::Test {
 protected:
  PressureCalibration::Outcome add(float pressure, std::uint32_t period_ms = 21) {
    return calibration.add(pressure, now += period_ms);
  }
  PressureCalibration calibration{kBaroVariance};
  std::uint32_t now = 0;
};

TEST_F(PressureCalibrationTest, PassesOver128Averages127AndEndsWithThe256th) {
  calibration.start();
  for (int k = 1; k <= 128; ++k) ASSERT_EQ(add(50000.0F), PressureCalibration::Outcome::kNone);
  for (int k = 1; k <= 127; ++k) {
    ASSERT_EQ(add(k % 2 == 0 ? 90000.0F : 90002.0F), PressureCalibration::Outcome::kNone);
  }
  EXPECT_EQ(add(1.0F), PressureCalibration::Outcome::kDone);
  EXPECT_NEAR(calibration.mean(), 90001.0F, 0.05F);
  EXPECT_FALSE(calibration.running());
}

TEST_F(PressureCalibrationTest, CountsOnlySamplesMoreThanTwentyMillisecondsApart) {
  calibration.start();
  int samples = 0;
  while (calibration.running()) {
    add(90000.0F, 10);
    ++samples;
  }
  EXPECT_EQ(samples, 3 * 256);  // every third: 30 ms
}

TEST_F(PressureCalibrationTest, StartsOverWhenTheVarianceIsTooGreat) {
  calibration.start();
  PressureCalibration::Outcome outcome = PressureCalibration::Outcome::kNone;
  for (int k = 0; k < 256; ++k) outcome = add(k % 2 == 0 ? 90000.0F : 90010.2F);  // variance 26
  EXPECT_EQ(outcome, PressureCalibration::Outcome::kUnsteady);
  EXPECT_TRUE(calibration.running());
  for (int k = 0; k < 256; ++k) outcome = add(k % 2 == 0 ? 90000.0F : 90009.7F);  // variance 23.7
  EXPECT_EQ(outcome, PressureCalibration::Outcome::kDone);
}

TEST(SensorFormulaTest, KnowsTheStandardAtmosphere) {
  EXPECT_NEAR(pressure_altitude(101325.0F), 0.0F, 1e-3F);
  EXPECT_NEAR(pressure_altitude(89874.6F), 1000.0F, 1.0F);
  EXPECT_NEAR(density_of(101325.0F), 1.225F, 1e-6F);
  EXPECT_NEAR(density_of(89874.6F), 1.1116F, 1e-3F);
  EXPECT_NEAR(indicated_airspeed(61.25F), 10.0F, 1e-4F);
  EXPECT_NEAR(indicated_airspeed(-61.25F), -10.0F, 1e-4F);
}

class SensorCorrectionsTest : public ::testing::Test {
 protected:
  ParameterStore parameters;
  SensorCorrections corrections;
};

TEST_F(SensorCorrectionsTest, SubtractsBiasesAndDrift) {
  parameters.set(parameter("GYRO_Y_BIAS"), 0.1F);
  parameters.set(parameter("ACC_Z_BIAS"), -0.2F);
  parameters.set(parameter("ACC_Z_TEMP_COMP"), 0.001F);
  corrections.configure(parameters);
  const ImuInput imu = corrections.corrected(corrections.rotated(
      {.acceleration = {0, 0, -9.8F}, .angular_velocity = {0, 0.3F, 0}, .temperature = 300.0F}));
  EXPECT_NEAR(imu.angular_velocity.y, 0.2F, 1e-6F);
  EXPECT_NEAR(imu.acceleration.z, -9.8F - (0.3F - 0.2F), 1e-5F);
}

TEST_F(SensorCorrectionsTest, TurnsPassivelyByTheMountingAngles) {
  parameters.set(parameter("IMU_YAW"), 90.0F);
  corrections.configure(parameters);
  // R(q)^T v: with a yaw of 90 degrees x of the input becomes -y of the output.
  const ImuInput imu = corrections.rotated({.acceleration = {1, 0, 0}, .angular_velocity = {}});
  EXPECT_NEAR(imu.acceleration.x, 0.0F, 1e-6F);
  EXPECT_NEAR(imu.acceleration.y, -1.0F, 1e-6F);
  parameters.set(parameter("IMU_YAW"), 0.0F);
  parameters.set(parameter("IMU_ROLL"), 180.0F);
  corrections.configure(parameters);
  const ImuInput inverted =
      corrections.rotated({.acceleration = {0, 0, 9.8F}, .angular_velocity = {1, 2, 3}});
  EXPECT_NEAR(inverted.acceleration.z, -9.8F, 1e-5F);
  EXPECT_NEAR(inverted.angular_velocity.x, 1.0F, 1e-6F);
  EXPECT_NEAR(inverted.angular_velocity.y, -2.0F, 1e-5F);
}

TEST_F(SensorCorrectionsTest, TurnsInertialUnitAndMagnetometerByAnglesOfTheirOwn) {
  const auto set = [&](const char* first, double roll, double pitch, double yaw) {
    const ParameterId id = find_parameter(first);
    parameters.set(id, static_cast<float>(roll));
    parameters.set(id + 1, static_cast<float>(pitch));
    parameters.set(id + 2, static_cast<float>(yaw));
  };
  const auto turned = [](double roll, double pitch, double yaw, const Eigen::Vector3d& v) -> Eigen::Vector3d {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const Eigen::Quaterniond q = Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitX());
    return q.conjugate() * v;
  };
  const auto expect = [](const Triple& found, const Eigen::Vector3d& wanted) {
    EXPECT_NEAR(found.x, wanted.x(), 1e-6);
    EXPECT_NEAR(found.y, wanted.y(), 1e-6);
    EXPECT_NEAR(found.z, wanted.z(), 1e-6);
  };
  set("IMU_ROLL", 10, 20, 30);
  set("MAG_ROLL", -40, 50, -60);
  corrections.configure(parameters);
  const ImuInput imu = corrections.rotated({.acceleration = {1, 2, 3}, .angular_velocity = {-1, 3, 2}});
  expect(imu.acceleration, turned(10, 20, 30, {1, 2, 3}));
  expect(imu.angular_velocity, turned(10, 20, 30, {-1, 3, 2}));
  expect(corrections.magnetic({1, 2, 3}), turned(-40, 50, -60, {1, 2, 3}));
}

TEST_F(SensorCorrectionsTest, SubtractsEveryBiasFromItsOwnAxis) {
  const char* kFirst[] = {"GYRO_X_BIAS", "ACC_X_BIAS", "ACC_X_TEMP_COMP", "MAG_X_BIAS"};
  for (const char* first : kFirst) {
    for (int axis = 0; axis < 3; ++axis) {
      parameters.set_defaults();
      parameters.set(find_parameter(first) + axis, 0.5F);
      corrections.configure(parameters);
      const ImuInput imu =
          corrections.corrected({.acceleration = {}, .angular_velocity = {}, .temperature = 2.0F});
      const Triple mag = corrections.magnetic({});
      const std::string name = first;
      const Triple& found = name[0] == 'G' ? imu.angular_velocity : name[0] == 'M' ? mag : imu.acceleration;
      const float wanted = name == "ACC_X_TEMP_COMP" ? -1.0F : -0.5F;
      EXPECT_EQ(found.x, axis == 0 ? wanted : 0.0F) << name;
      EXPECT_EQ(found.y, axis == 1 ? wanted : 0.0F) << name;
      EXPECT_EQ(found.z, axis == 2 ? wanted : 0.0F) << name;
    }
  }
}

TEST_F(SensorCorrectionsTest, TakesHardThenSoftIronOutOfTheField) {
  parameters.set(parameter("MAG_X_BIAS"), 0.1F);
  parameters.set(parameter("MAG_CAL_A01"), 2.0F);
  corrections.configure(parameters);
  const Triple field = corrections.magnetic({0.3F, 0.4F, 0.5F});
  EXPECT_NEAR(field.x, 0.2F + 0.8F, 1e-6F);
  EXPECT_NEAR(field.y, 0.4F, 1e-6F);
}

TEST(BatteryMonitorTest, FollowsSlowlyFromTheGreatestVoltage) {
  ParameterStore parameters;
  parameters.set(parameter("BATT_VOLT_LPF"), 0.5F);  // saved, therefore without effect
  parameters.set(parameter("BATT_VOLT_MULT"), 2.0F);
  parameters.set(parameter("BATT_CURR_MULT"), 0.0F);  // ignored
  BatteryMonitor battery;
  battery.start(parameters);
  EXPECT_EQ(battery.voltage(), 25.0F);
  battery.add({10.0F, 8.0F});
  EXPECT_NEAR(battery.voltage(), 0.005F * 20.0F + 0.995F * 25.0F, 1e-5F);
  EXPECT_NEAR(battery.current(), 0.005F * 8.0F, 1e-6F);
  battery.change_filters(parameters);
  const float before = battery.voltage();
  battery.add({10.0F, 8.0F});
  EXPECT_NEAR(battery.voltage(), 0.5F * (20.0F + before), 1e-5F);
}

TEST(BatteryMonitorTest, NeedsTwentySecondsAtTenHertz) {
  ParameterStore parameters;
  BatteryMonitor battery;
  battery.start(parameters);
  for (int k = 0; k < 200; ++k) battery.add({24.0F, 0.0F});
  EXPECT_NEAR(battery.voltage(), 24.0 + std::exp(-200.0 * 0.005), 0.002);
}

TEST(BatteryMonitorTest, JudgesEachReadingOfASampleByItself) {
  ParameterStore parameters;
  BatteryMonitor battery;
  battery.start(parameters);
  battery.add({1e30F, 8.0F});
  EXPECT_EQ(battery.voltage(), 25.0F);
  EXPECT_GT(battery.current(), 0.0F);
  const float current = battery.current();
  battery.add({20.0F, -1e30F});
  EXPECT_LT(battery.voltage(), 25.0F);
  EXPECT_EQ(battery.current(), current);
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
