#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "hil_bridge/translate/command_encoder.hpp"
#include "hil_bridge/translate/sensor_frame_builder.hpp"
#include "hil_bridge/translate/telemetry.hpp"

namespace ironbird::hil_bridge {
namespace {

using autopilot::SensorFrame;
using autopilot::Vector3;

constexpr double kFloat32 = 1e-6;  // relative rounding of the wire's numbers
const float kNan = std::numeric_limits<float>::quiet_NaN();

rosflight::SmallImu imu_at(std::uint64_t us) {
  rosflight::SmallImu imu;
  imu.time_boot_us = us;
  imu.zacc = -9.80665f;
  imu.xgyro = 0.25f;
  return imu;
}

rosflight::RosflightGnss some_fix() {
  rosflight::RosflightGnss gnss;
  gnss.lat = 40.0;
  gnss.lon = -111.5;
  gnss.height = 1387.0f;
  gnss.vel_n = 1.5f;
  gnss.vel_d = -0.25f;
  gnss.rosflight_timestamp = 2400;
  gnss.h_acc = 0.5f;
  gnss.v_acc = 0.75f;
  gnss.s_acc = 0.125f;
  gnss.fix_type = 3;
  gnss.num_sat = 15;
  return gnss;
}

TEST(SensorFrameBuilderTest, MakesAFrameForEachImuMessageAndForNoOther) {
  SensorFrameBuilder builder;
  EXPECT_EQ(builder.push({Time{0}, rosflight::SmallMag{}}), nullptr);
  const SensorFrame* frame = builder.push({Time{0}, imu_at(2500)});
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->imu.stamp, Time{2'500'000});
  EXPECT_NEAR(frame->imu.f_B.z(), -9.80665, 9.8 * kFloat32);
  EXPECT_DOUBLE_EQ(frame->imu.w_NB_B.x(), 0.25);
  EXPECT_TRUE(frame->mag.has_value());
  EXPECT_FALSE(frame->baro.has_value());
}

TEST(SensorFrameBuilderTest, GivesEachSlowSampleToExactlyOneFrame) {
  SensorFrameBuilder builder;
  builder.push({Time{0}, rosflight::SmallBaro{100.0f, 100000.0f, 290.0f}});
  EXPECT_TRUE(builder.push({Time{0}, imu_at(2500)})->baro.has_value());
  EXPECT_FALSE(builder.push({Time{0}, imu_at(5000)})->baro.has_value());
}

TEST(SensorFrameBuilderTest, TranslatesEveryFieldOfAFix) {
  SensorFrameBuilder builder;
  builder.push({Time{0}, some_fix()});
  const SensorFrame* frame = builder.push({Time{0}, imu_at(2500)});
  ASSERT_TRUE(frame->gnss.has_value());
  const autopilot::GnssSample& gnss = *frame->gnss;
  EXPECT_EQ(gnss.stamp, Time{2'400'000});
  EXPECT_DOUBLE_EQ(gnss.latitude, 40.0 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(gnss.longitude, -111.5 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(gnss.altitude, 1387.0);
  EXPECT_EQ(gnss.v_NB_N, Vector3(1.5, 0.0, -0.25));
  EXPECT_DOUBLE_EQ(gnss.horizontal_accuracy, 0.5);
  EXPECT_DOUBLE_EQ(gnss.vertical_accuracy, 0.75);
  EXPECT_DOUBLE_EQ(gnss.speed_accuracy, 0.125);
  EXPECT_EQ(gnss.fix, autopilot::GnssFix::kFix3D);
  EXPECT_EQ(gnss.satellites, 15);
}

TEST(SensorFrameBuilderTest, StampsSensorsWithoutStampByTheLatestImuMessage) {
  SensorFrameBuilder builder;
  builder.push({Time{0}, imu_at(2500)});
  builder.push({Time{0}, rosflight::SmallMag{1.0f, 0.0f, 0.5f}});
  const SensorFrame* frame = builder.push({Time{0}, imu_at(5000)});
  EXPECT_EQ(frame->mag->stamp, Time{2'500'000});
}

TEST(SensorFrameBuilderTest, PutsTheBatteryVoltageIntoTheStatus) {
  SensorFrameBuilder builder;
  builder.push({Time{0}, rosflight::RosflightBatteryStatus{23.5f, 1.0f}});
  rosflight::RosflightStatus status;
  status.armed = 1;
  status.rc_override = 0x3C0;
  builder.push({Time{7}, status});
  const SensorFrame* frame = builder.push({Time{8}, imu_at(2500)});
  ASSERT_TRUE(frame->status.has_value());
  EXPECT_TRUE(frame->status->armed);
  EXPECT_FALSE(frame->status->failsafe);
  EXPECT_EQ(frame->status->rc_override, 0x3C0);
  EXPECT_DOUBLE_EQ(frame->status->battery_voltage, 23.5);
  EXPECT_EQ(frame->status->stamp, Time{7});
  EXPECT_TRUE(frame->status->imu_calibrated);
}

TEST(SensorFrameBuilderTest, SaysWhenTheInertialUnitIsNotCalibrated) {
  SensorFrameBuilder builder;
  rosflight::RosflightStatus status;
  status.error_code = 0x24;
  builder.push({Time{0}, status});
  EXPECT_FALSE(builder.push({Time{0}, imu_at(2500)})->status->imu_calibrated);
}

TEST(SensorFrameBuilderTest, RefusesSlowSensorsThatAreNotFinite) {
  SensorFrameBuilder builder;
  builder.push({Time{0}, rosflight::SmallMag{kNan, 0.0f, 0.5f}});
  builder.push({Time{0}, rosflight::SmallBaro{0.0f, kNan, 290.0f}});
  rosflight::RosflightGnss gnss = some_fix();
  gnss.vel_e = kNan;
  builder.push({Time{0}, gnss});
  const SensorFrame* frame = builder.push({Time{0}, imu_at(2500)});
  EXPECT_FALSE(frame->mag.has_value());
  EXPECT_FALSE(frame->baro.has_value());
  EXPECT_FALSE(frame->gnss.has_value());
}

TEST(CommandEncoderTest, SendsNothingForSilence) {
  EXPECT_FALSE(encode(autopilot::SilenceCommand{}).has_value());
}

TEST(CommandEncoderTest, TurnsThrustIntoNegativeForceInPassThrough) {
  const auto control = encode(autopilot::PassThroughCommand{.M_B = {0.1, -0.2, 0.05}, .thrust = 34.335});
  ASSERT_TRUE(control.has_value());
  EXPECT_EQ(control->mode, 0);
  EXPECT_EQ(control->ignore, 0);
  EXPECT_FLOAT_EQ(control->u[2], -34.335f);
  EXPECT_FLOAT_EQ(control->u[3], 0.1f);
  EXPECT_FLOAT_EQ(control->u[4], -0.2f);
  EXPECT_FLOAT_EQ(control->u[5], 0.05f);
}

TEST(CommandEncoderTest, KeepsThrottlePositiveInRateAndAngleModes) {
  const auto rates = encode(autopilot::RateCommand{.w_NB_B = {1.0, 2.0, 3.0}, .throttle = 0.5});
  const auto angles =
      encode(autopilot::AngleCommand{.roll = 0.1, .pitch = 0.2, .heading_rate = 0.3, .throttle = 0.6});
  ASSERT_TRUE(rates && angles);
  EXPECT_EQ(rates->mode, 1);
  EXPECT_FLOAT_EQ(rates->u[2], 0.5f);
  EXPECT_FLOAT_EQ(rates->u[5], 3.0f);
  EXPECT_EQ(angles->mode, 2);
  EXPECT_FLOAT_EQ(angles->u[2], 0.6f);
  EXPECT_FLOAT_EQ(angles->u[4], 0.2f);
}

TEST(CommandEncoderTest, WithholdsWhatIsNotFiniteOnTheWire) {
  EXPECT_FALSE(
      encode(autopilot::PassThroughCommand{.thrust = std::numeric_limits<double>::quiet_NaN()}).has_value());
  EXPECT_FALSE(encode(autopilot::RateCommand{.throttle = 1e300}).has_value());
}

TEST(SensorFrameBuilderTest, TellsHowTheMotorsAreDrivenAsSoonAsTheFcuSaysSo) {
  SensorFrameBuilder builder;
  const Time now = std::chrono::milliseconds(3);
  rosflight::RosflightOutputRaw outputs;
  outputs.values[0] = 0.1f;
  outputs.values[2] = 0.25f;
  // GIVEN nothing but outputs THEN there is no status
  builder.push({now, outputs});
  EXPECT_FALSE(builder.push({now, rosflight::SmallImu{}})->status.has_value());
  // WHEN the status comes THEN it has them
  rosflight::RosflightStatus status;
  status.armed = 1;
  builder.push({now, status});
  const autopilot::SensorFrame* frame = builder.push({now, rosflight::SmallImu{}});
  ASSERT_TRUE(frame->status.has_value());
  EXPECT_FLOAT_EQ(static_cast<float>(frame->status->greatest_output.value()), 0.25f);
  // WHEN the outputs change THEN so does what is said of them, and nothing else
  outputs.values[2] = 0.0f;
  builder.push({now + now, outputs});
  frame = builder.push({now, rosflight::SmallImu{}});
  ASSERT_TRUE(frame->status.has_value());
  EXPECT_FLOAT_EQ(static_cast<float>(frame->status->greatest_output.value()), 0.1f);
  EXPECT_TRUE(frame->status->armed);
  EXPECT_EQ(frame->status->stamp, now);
  EXPECT_EQ(frame->status->output_stamp, now + now);
}

TEST(TelemetryTest, KeepsTheLatestOfEachKind) {
  Telemetry telemetry;
  rosflight::RosflightOutputRaw outputs;
  outputs.values[3] = 0.5f;
  telemetry.take(outputs);
  outputs.values[3] = 0.75f;
  telemetry.take(outputs);
  EXPECT_FLOAT_EQ(telemetry.output_raw.values[3], 0.75f);
}

}  // namespace
}  // namespace ironbird::hil_bridge
