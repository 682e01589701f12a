#include <gtest/gtest.h>

#include <limits>

#include "hil_bridge/virtual_fcu/test/fake_board.hpp"

// What the firmware does with messages: parameters, commands, calibrations, clock.

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

using namespace rosflight;

ParamSet set_integer(std::string_view name, std::int32_t value) {
  return {{bits_of(value)}, 1, 0, name_field(name), 6};
}
ParamSet set_real(std::string_view name, float value) {
  return {{bits_of(value)}, 1, 0, name_field(name), 9};
}

class LinkTest : public ::testing::Test {
 protected:
  LinkTest() : fcu(armable()) {
    fcu.deliver(Heartbeat{});
    for (int k = 0; k < 40; ++k) fcu.pass();
    fcu.forget_sent();
  }
  std::vector<ParamValue> answers() const { return fcu.sent<ParamValue>(); }
  int order(std::uint8_t command) {
    fcu.forget_sent();
    fcu.deliver(RosflightCmd{command});
    const auto acks = fcu.sent<RosflightCmdAck>();
    EXPECT_EQ(acks.size(), 1U);
    EXPECT_EQ(acks.back().command, command);
    return acks.back().success;
  }
  void fly() {
    fcu.rc_pass();
    fcu.arm();
    ASSERT_TRUE(fcu.firmware().arming().armed());
  }

  FakeBoard fcu;
};

TEST_F(LinkTest, AnswersASetWithTheNewValue) {
  fcu.deliver(set_integer("NUM_MOTORS", 6));
  ASSERT_EQ(answers().size(), 1U);
  EXPECT_EQ(answers()[0].param_index, 2);
  EXPECT_EQ(answers()[0].param_count, 333);
  EXPECT_EQ(answers()[0].param_type, 6);
  EXPECT_EQ(answers()[0].param_value.bits, 6U);
}

TEST_F(LinkTest, KeepsSilentForASetThatChangesNothingOrMakesNoSense) {
  fcu.deliver(set_integer("NUM_MOTORS", 4));
  fcu.deliver(set_real("NUM_MOTORS", 6.0F));
  fcu.deliver(set_integer("PID_TAU", 1));
  fcu.deliver(set_integer("NO_SUCH_THING", 1));
  fcu.deliver(ParamSet{{bits_of(6)}, 2, 0, name_field("NUM_MOTORS"), 6});
  fcu.deliver(ParamSet{{bits_of(6)}, 1, 0, name_field("NUM_MOTORS"), 5});
  EXPECT_TRUE(answers().empty());
  EXPECT_EQ(fcu.firmware().parameters().integer(parameter("NUM_MOTORS")), 4);
}

TEST_F(LinkTest, AnswersEverySetOfANan) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  fcu.deliver(set_real("X_EQ_TORQUE", nan));
  fcu.deliver(set_real("X_EQ_TORQUE", nan));
  EXPECT_EQ(answers().size(), 2U);
}

TEST_F(LinkTest, AcceptsASetWhileArmed) {
  fly();
  fcu.deliver(set_real("PID_TAU", 0.06F));
  EXPECT_EQ(answers().size(), 1U);
}

TEST_F(LinkTest, FindsNamesOfSixteenCharacters) {
  fcu.deliver(set_real("MOTOR_RESISTANCE", 0.05F));
  ASSERT_EQ(answers().size(), 1U);
  EXPECT_EQ(answers()[0].param_index, 3);
}

TEST_F(LinkTest, ReadsParametersByIndexOrName) {
  fcu.deliver(ParamRequestRead{252, 1, 0, {}});
  fcu.deliver(ParamRequestRead{-1, 1, 0, name_field("RC_ARM_THRESHOLD")});
  fcu.deliver(ParamRequestRead{333, 1, 0, {}});
  fcu.deliver(ParamRequestRead{-1, 1, 0, name_field("NOTHING")});
  fcu.deliver(ParamRequestRead{252, 7, 0, {}});
  ASSERT_EQ(answers().size(), 2U);
  EXPECT_EQ(answers()[0].param_id, name_field("FAILSAFE_THR"));
  EXPECT_EQ(answers()[1].param_index, 327);
}

TEST_F(LinkTest, ListsOneParameterPerPassAndStartsAgainOnRequest) {
  fcu.deliver(ParamRequestList{1, 0});
  for (int k = 0; k < 100; ++k) fcu.pass();
  EXPECT_EQ(answers().size(), 100U);
  fcu.forget_sent();
  fcu.deliver(ParamRequestList{1, 0});
  for (int k = 0; k < 400; ++k) fcu.pass();
  const auto values = answers();
  ASSERT_EQ(values.size(), 334U);  // the pass that read the request had sent one more
  for (std::uint16_t k = 0; k < 333; ++k) ASSERT_EQ(values[k + 1].param_index, k);
}

TEST_F(LinkTest, AnswersToItsNewSystemIdAtOnce) {
  fcu.deliver(set_integer("SYS_ID", 9));
  fcu.forget_sent();
  fcu.deliver(ParamRequestRead{0, 1, 0, {}});
  EXPECT_TRUE(answers().empty());
  fcu.deliver(ParamRequestRead{0, 9, 0, {}});
  EXPECT_EQ(answers().size(), 1U);
}

TEST_F(LinkTest, SendsTheCascadeOfACannedMixerBeforeTheTrigger) {
  fcu.deliver(set_integer("PRIMARY_MIXER", 4));
  const auto values = answers();
  ASSERT_GT(values.size(), 20U);
  EXPECT_EQ(values.back().param_id, name_field("PRIMARY_MIXER"));
  EXPECT_EQ(fcu.firmware().parameters().integer(parameter("PRI_MIXER_OUT_5")), 2);
}

TEST_F(LinkTest, AppliesOneMixerElementAtOnce) {
  fly();
  fcu.imu_passes(2);
  fcu.deliver(set_real("SEC_MIXER_2_0", -0.5F));
  fcu.deliver(OffboardControl{.u = {0, 0, -0.5F}, .ignore = 0, .mode = 0});
  fcu.rc_pass();
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[0], 0.25F, 1e-6F);
  EXPECT_NEAR(fcu.board().outputs[1], 0.5F, 1e-5F);
}

TEST_F(LinkTest, RaisesAndClearsTheErrorsOfItsParameters) {
  fcu.deliver(set_real("FAILSAFE_THR", 1.1F));
  EXPECT_EQ(fcu.firmware().arming().errors(), kInvalidFailsafe);
  fcu.deliver(set_integer("PRIMARY_MIXER", 12));
  EXPECT_EQ(fcu.firmware().arming().errors(), kInvalidFailsafe | kInvalidMixer);
  fcu.deliver(set_real("FAILSAFE_THR", 1.0F));
  fcu.deliver(set_integer("PRIMARY_MIXER", 2));
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
  EXPECT_EQ(fcu.firmware().arming().state(), State::kPreflight);
}

TEST_F(LinkTest, RecomputesTheMaximumThrustOnlyForTheListedParameters) {
  const float before = fcu.firmware().controller().maximum_thrust();
  EXPECT_NEAR(before, 292.3F, 0.1F);
  fcu.deliver(set_real("PROP_CQ", 0.006F));
  EXPECT_EQ(fcu.firmware().controller().maximum_thrust(), before);
  fcu.board().baro = PressureInput{80000.0F, 290.0F};
  fcu.pass();
  EXPECT_EQ(fcu.firmware().controller().maximum_thrust(), before) << "not with the density";
  fcu.deliver(set_integer("NUM_MOTORS", 8));
  EXPECT_NE(fcu.firmware().controller().maximum_thrust(), 2.0F * before) << "now with density and CQ";
}

TEST_F(LinkTest, DoesNotRunCallbacksForDefaultsOrForLoadedValues) {
  EXPECT_EQ(order(7), 1);
  EXPECT_TRUE(answers().empty());
  EXPECT_EQ(fcu.firmware().parameters().integer(parameter("PRIMARY_MIXER")), 255);
  EXPECT_TRUE(fcu.firmware().mixer().valid()) << "the old mixer works on";
  EXPECT_EQ(order(5), 1);
  EXPECT_EQ(fcu.firmware().parameters().integer(parameter("PRIMARY_MIXER")), 2);
}

TEST_F(LinkTest, SavesWhatItHasOnRequest) {
  fcu.deliver(set_real("PID_TAU", 0.07F));
  EXPECT_EQ(order(6), 1);
  order(7);
  order(5);
  EXPECT_EQ(fcu.firmware().parameters().real(parameter("PID_TAU")), 0.07F);
}

TEST_F(LinkTest, RefusesEveryCommandWhileArmed) {
  fly();
  for (std::uint8_t command = 0; command <= 13; ++command) EXPECT_EQ(order(command), 0) << int{command};
  EXPECT_TRUE(fcu.sent<RosflightVersion>().empty());
}

TEST_F(LinkTest, AcceptsKnownCommandsAndRefusesOthers) {
  for (std::uint8_t command : {1, 2, 3, 4, 8, 9}) EXPECT_EQ(order(command), 1) << int{command};
  for (std::uint8_t command : {11, 12, 13, 255}) EXPECT_EQ(order(command), 0) << int{command};
}

TEST_F(LinkTest, SendsItsVersionBeforeTheAcknowledgement) {
  EXPECT_EQ(order(10), 1);
  ASSERT_EQ(fcu.all_sent().size(), 2U);
  EXPECT_TRUE(std::holds_alternative<RosflightVersion>(fcu.all_sent()[0].message));
}

TEST_F(LinkTest, AnswersTimeRequestsButNotAnswers) {
  fcu.wait(1500 - fcu.board().clock_us);
  fcu.deliver(Timesync{.tc1 = 0, .ts1 = 77});
  fcu.deliver(Timesync{.tc1 = 5, .ts1 = 78});
  ASSERT_EQ(fcu.sent<Timesync>().size(), 1U);
  EXPECT_EQ(fcu.sent<Timesync>()[0].tc1, 1500000);
  EXPECT_EQ(fcu.sent<Timesync>()[0].ts1, 77);
}

// ---- calibrations ----

class CalibrationTest : public ::testing::Test {
 protected:
  CalibrationTest()
      : fcu({{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.3}, {"RC_NUM_CHN", 8}, {"RC_ARM_CHN", 4}}) {
    fcu.put(Heartbeat{});
    for (int k = 0; k < 40; ++k) fcu.pass();
    fcu.forget_sent();
  }
  void samples(int count, Triple acceleration, Triple rate) {
    for (int k = 0; k < count; ++k) fcu.imu_pass(acceleration, rate);
  }
  float value(std::string_view name) const { return fcu.firmware().parameters().real(find_parameter(name)); }

  FakeBoard fcu;
};

TEST_F(CalibrationTest, FindsBothBiasesAndClearsTheError) {
  fcu.deliver(RosflightCmd{1});
  samples(1000, {0.1F, -0.2F, -9.7F}, {0.01F, -0.02F, 0.03F});
  EXPECT_EQ(fcu.firmware().arming().errors(), kUncalibratedImu);
  EXPECT_EQ(value("GYRO_X_BIAS"), 0.0F);
  samples(1, {0.1F, -0.2F, -9.7F}, {0.01F, -0.02F, 0.03F});
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
  EXPECT_NEAR(value("GYRO_Y_BIAS"), -0.02F, 1e-5F);
  EXPECT_NEAR(value("ACC_X_BIAS"), 0.1F, 1e-4F);
  EXPECT_NEAR(value("ACC_Z_BIAS"), kGravity - 9.7F, 1e-3F);
  EXPECT_EQ(fcu.texts("IMU offsets stored"), 1);
  EXPECT_EQ(fcu.sent<ParamValue>().size(), 6U);
  fcu.forget_sent();
  samples(1, {0.1F, -0.2F, -9.7F}, {0.01F, -0.02F, 0.03F});
  EXPECT_NEAR(fcu.sent<SmallImu>().back().xgyro, 0.0F, 1e-5F) << "samples are corrected from now on";
}

TEST_F(CalibrationTest, LeavesBiasesAtZeroWhenTheVehicleMoved) {
  fcu.deliver(RosflightCmd{1});
  for (int k = 0; k < 1001; ++k) samples(1, {k % 2 == 0 ? 0.6F : -0.6F, 0, -9.8F}, {2.0F, 0, 0});
  EXPECT_EQ(fcu.firmware().arming().errors(), kUncalibratedImu);
  EXPECT_EQ(value("ACC_X_BIAS"), 0.0F);
  EXPECT_EQ(value("GYRO_X_BIAS"), 0.0F);
  EXPECT_EQ(fcu.texts("movement"), 2);
}

TEST_F(CalibrationTest, RefusesABiasOfThreeMetresPerSecondSquared) {
  fcu.deliver(RosflightCmd{1});
  samples(1001, {3.1F, 0, -9.8F}, {});
  EXPECT_EQ(fcu.texts("accelerometer bias too large: 3.10"), 1);
  EXPECT_EQ(value("ACC_X_BIAS"), 0.0F);
}

TEST_F(CalibrationTest, DoesNotClearTheErrorWithTheGyroAlone) {
  fcu.deliver(RosflightCmd{2});
  samples(1001, {0, 0, -9.8F}, {0.01F, 0, 0});
  EXPECT_NEAR(value("GYRO_X_BIAS"), 0.01F, 1e-5F);
  EXPECT_EQ(fcu.firmware().arming().errors(), kUncalibratedImu);
}

TEST_F(CalibrationTest, DoesNotClearTheErrorByLoadedBiases) {
  fcu.deliver(set_real("GYRO_X_BIAS", 0.01F));
  EXPECT_EQ(fcu.firmware().arming().errors(), kUncalibratedImu);
}

TEST_F(CalibrationTest, RaisesTheErrorWhenTheMountingChangesWithoutBiases) {
  fcu.deliver(RosflightCmd{1});
  samples(1001, {0, 0, -kGravity}, {});
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
  fcu.deliver(set_real("IMU_YAW", 90.0F));
  EXPECT_EQ(fcu.firmware().arming().errors(), kUncalibratedImu) << "a perfect IMU has biases of zero";
}

TEST_F(CalibrationTest, ArmsAfterTheGyroCalibrationWhenAskedTo) {
  FakeBoard careful(armable({{"ARM_CAL_GYRO", 1}}));
  careful.rc_pass();
  careful.arm();
  EXPECT_EQ(careful.firmware().arming().state(), State::kCalibrating);
  for (int k = 0; k < 1000; ++k) careful.imu_pass({0, 0, -9.8F}, {0.01F, 0, 0});
  EXPECT_FALSE(careful.firmware().arming().armed());
  careful.imu_pass({0, 0, -9.8F}, {0.01F, 0, 0});
  EXPECT_TRUE(careful.firmware().arming().armed());
}

TEST_F(CalibrationTest, GoesBackToPreflightWhenThatCalibrationFails) {
  FakeBoard careful(armable({{"ARM_CAL_GYRO", 1}}));
  careful.rc_pass();
  careful.arm();
  for (int k = 0; k < 1001; ++k) careful.imu_pass({0, 0, -9.8F}, {1.5F, 0, 0});
  EXPECT_EQ(careful.firmware().arming().state(), State::kPreflight);
}

TEST_F(CalibrationTest, CalibratesThePressuresAtBootWithoutCorrectingThePressure) {
  for (int k = 0; k < 256; ++k) {
    fcu.wait(21000);
    fcu.board().baro = PressureInput{85750.0F, 290.0F};
    fcu.board().differential_pressure = PressureInput{3.0F, 290.0F};
    fcu.pass();
  }
  EXPECT_NEAR(value("BARO_BIAS"), 85750.0F, 0.1F);
  EXPECT_NEAR(value("GROUND_LEVEL"), 1387.0F, 10.0F);
  EXPECT_NEAR(value("DIFF_PRESS_BIAS"), 3.0F, 1e-3F);
  EXPECT_EQ(fcu.texts("calibration finished"), 2);
  EXPECT_EQ(fcu.sent<SmallBaro>().back().pressure, 85750.0F);
  EXPECT_NEAR(fcu.sent<DiffPressure>().back().diff_pressure, 0.0F, 1e-3F);
}

TEST_F(CalibrationTest, TakesFiveToSixSecondsForPressuresOfAnyRate) {
  // GIVEN a barometer at 50 Hz, whose period is the very 20 ms that must be exceeded, and a pitot tube at 100
  // Hz
  std::vector<double> finished;
  for (int tick = 1; tick < 2800; ++tick) {
    if (tick % 8 == 0) fcu.board().baro = PressureInput{85750.0F + static_cast<float>(tick % 3), 290.0F};
    if (tick % 4 == 0) fcu.board().differential_pressure = PressureInput{3.0F, 290.0F};
    fcu.imu_pass();
    if (fcu.texts("calibration finished") > static_cast<int>(finished.size()))
      finished.push_back(2.5e-3 * tick);
  }
  ASSERT_EQ(finished.size(), 2U);
  for (const double seconds : finished) {
    EXPECT_GT(seconds, 5.0);
    EXPECT_LT(seconds, 6.0);
  }
  EXPECT_EQ(fcu.texts("too much movement"), 0);
  EXPECT_NEAR(value("BARO_BIAS"), 85751.0F, 0.5F);
}

TEST_F(CalibrationTest, WaitsForTheFirstPressure) {
  for (int tick = 1; tick < 2800; ++tick) fcu.imu_pass();
  EXPECT_EQ(fcu.texts("calibration finished"), 0);
}

TEST_F(CalibrationTest, AddsTheTorquesOfTheSticksToTheTrims) {
  fcu.deliver(set_real("X_EQ_TORQUE", 0.5F));
  fcu.frame().channels[0] = 0.6F;
  fcu.rc_pass();
  fcu.deliver(RosflightCmd{0});
  EXPECT_NEAR(value("X_EQ_TORQUE"), 0.5F + 0.15F * 0.2F * 0.786F, 1e-5F);
  EXPECT_EQ(fcu.texts("equilibrium"), 2);
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
