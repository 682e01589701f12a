#include "hil_bridge/virtual_fcu/firmware.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hil_bridge/virtual_fcu/test/fake_board.hpp"

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

using namespace rosflight;

TEST(FirmwareTest, BootsADefaultBoardWithThreeErrors) {
  FakeBoard fcu;
  fcu.wait(100000);
  fcu.pass();
  EXPECT_EQ(fcu.firmware().arming().errors(), 0xA1);
  EXPECT_EQ(fcu.firmware().arming().state(), State::kError);
  ASSERT_FALSE(fcu.sent<RosflightStatus>().empty());
  EXPECT_EQ(fcu.sent<RosflightStatus>().back().error_code, 0xA1);
}

TEST(FirmwareTest, RefusesSavedParametersThatMakeNoSense) {
  EXPECT_THROW(FakeBoard({{"PID_TAUU", 0.1}}), std::invalid_argument);
  EXPECT_THROW(FakeBoard({{"NUM_MOTORS", 4.5}}), std::invalid_argument);
  EXPECT_THROW(FakeBoard({{"NUM_MOTORS", 1e12}}), std::invalid_argument);
}

TEST(FirmwareTest, ArmsByTheSwitchAndSaysSoAtOnce) {
  FakeBoard fcu(armable());
  fcu.rc_pass();
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
  fcu.forget_sent();
  fcu.arm();
  EXPECT_TRUE(fcu.firmware().arming().armed());
  ASSERT_FALSE(fcu.sent<RosflightStatus>().empty());
  EXPECT_EQ(fcu.sent<RosflightStatus>().front().armed, 1);
}

// ---- order of a pass ----

/// A board whose firmware is armed and has seen two IMU samples.
class FlyingBoard : public FakeBoard {
 public:
  FlyingBoard() : FakeBoard(armable()) {
    rc_pass();
    imu_passes(2);
    arm();
    wait(5000);
  }
};

OffboardControl thrust(float up) {
  return {.u = {0, 0, -up}, .ignore = 0, .mode = 0};
}

TEST(FirmwareOrderTest, FliesTheCombinationMadeAtTheEndOfThePassBefore) {
  FakeBoard fcu(armable());
  fcu.rc_pass();
  fcu.imu_passes(2);
  fcu.arm();
  // GIVEN command and RC arrive in the very pass that has an IMU sample
  fcu.put(thrust(0.5F));
  fcu.board().rc = fcu.frame();
  fcu.imu_pass();
  // THEN this pass still flew the pilot's closed throttle: idle
  EXPECT_EQ(fcu.board().outputs[0], 0.1F);
  // AND the next one flies the command
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[0], 0.5F, 1e-5F);
}

TEST(FirmwareOrderTest, AdoptsACommandOnlyWithAnRcFrame) {
  FakeBoard fcu(armable());
  fcu.rc_pass();
  fcu.imu_passes(2);
  fcu.arm();
  fcu.deliver(thrust(0.5F));
  fcu.imu_passes(5);
  EXPECT_EQ(fcu.board().outputs[0], 0.1F);
  fcu.rc_pass();
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[0], 0.5F, 1e-5F);
  // AND holds it for ever in silence
  fcu.imu_passes(4000);
  EXPECT_NEAR(fcu.board().outputs[0], 0.5F, 1e-5F);
  EXPECT_EQ(fcu.firmware().arming().errors() & kErrorRcLost, 0);
}

TEST(FirmwareOrderTest, KeepsTimeOnlyWithTheFirstSampleAndTheFilterWithTheSecond) {
  FakeBoard fcu(armable());
  const Triple spin = {1.0F, 0.0F, 0.0F};
  fcu.imu_pass({0, 0, -kGravity}, spin);
  fcu.imu_pass({0, 0, -kGravity}, spin);
  EXPECT_EQ(fcu.firmware().filter().attitude().w_NB_B.x, 0.0F);
  fcu.imu_pass({0, 0, -kGravity}, spin);
  EXPECT_NEAR(fcu.firmware().filter().attitude().w_NB_B.x, 0.7F, 1e-5F);
}

TEST(FirmwareOrderTest, SkipsASampleFromThePastAndRecoversWithTheNext) {
  FlyingBoard fcu;
  const auto sample = [&](std::uint64_t stamp) {
    fcu.board().imu = ImuInput{.stamp_us = stamp, .acceleration = {0, 0, -kGravity}, .angular_velocity = {}};
    fcu.pass();
  };
  const std::uint64_t now = fcu.board().clock_us;
  sample(now);
  sample(now - 1);
  EXPECT_EQ(fcu.firmware().arming().errors(), kTimeGoingBackwards);
  EXPECT_TRUE(fcu.firmware().arming().armed());
  sample(now);
  EXPECT_EQ(fcu.firmware().arming().errors(), 0);
  sample(now);
  EXPECT_EQ(fcu.firmware().arming().errors(), 0) << "a step of zero is allowed";
}

// ---- RC ----

TEST(FirmwareRcTest, FliesFailsafeWhileFramesAreFlaggedLostAndComesBack) {
  FlyingBoard fcu;
  fcu.deliver(thrust(0.6F));
  fcu.rc_pass();
  fcu.frame().failsafe = true;
  fcu.rc_pass();
  EXPECT_TRUE(fcu.firmware().arming().failsafe());
  EXPECT_TRUE(fcu.firmware().arming().armed());
  EXPECT_EQ(fcu.firmware().commands().overrides(), 0) << "left as it was";
  fcu.imu_pass();
  EXPECT_NEAR(fcu.board().outputs[0], 0.3F * 0.7F, 1e-5F);  // FAILSAFE_THR x RC_MAX_THR
  EXPECT_EQ(fcu.sent<RosflightStatus>().back().failsafe, 1);
  fcu.frame().failsafe = false;
  fcu.rc_pass();
  EXPECT_FALSE(fcu.firmware().arming().failsafe());
  EXPECT_EQ(fcu.firmware().arming().state(), State::kArmed);
}

TEST(FirmwareRcTest, DisarmsBySwitchAtAnyThrottle) {
  FlyingBoard fcu;
  fcu.frame().channels[2] = 1.0F;
  fcu.frame().channels[4] = 0.0F;
  fcu.rc_pass();
  EXPECT_FALSE(fcu.firmware().arming().armed());
  fcu.imu_pass();
  EXPECT_EQ(fcu.board().outputs[0], 0.0F);
}

TEST(FirmwareRcTest, ExplainsARefusalOncePerSecondWithOneLinePerReason) {
  FakeBoard fcu({{"RC_ARM_CHN", 4}, {"RC_NUM_CHN", 8}, {"RC_ATT_OVRD_CHN", 5}, {"RC_THR_OVRD_CHN", 5}});
  fcu.deliver(Heartbeat{});
  fcu.wait(1);
  fcu.arm();
  EXPECT_EQ(fcu.texts("arming refused"), 3);
  for (int k = 0; k < 100; ++k) {
    fcu.wait(10000);
    fcu.rc_pass();
  }
  EXPECT_EQ(fcu.texts("arming refused"), 3) << "1000 ms are not more than 1000 ms";
  fcu.wait(10000);
  fcu.rc_pass();
  EXPECT_EQ(fcu.texts("arming refused"), 6);
  EXPECT_FALSE(fcu.firmware().arming().armed());
}

TEST(FirmwareRcTest, NeedsLowThrottleAndAProtectedThrottleToArm) {
  FakeBoard fcu(armable({{"TAKE_MIN_THR", 0}}));
  fcu.deliver(Heartbeat{});
  fcu.frame().channels[2] = 0.2F;
  fcu.arm();
  EXPECT_EQ(fcu.texts("throttle stick too high"), 1);
  fcu.frame().channels[2] = 0.1F;
  fcu.rc_pass();
  EXPECT_EQ(fcu.texts("override is off"), 1);
  EXPECT_FALSE(fcu.firmware().arming().armed());
  fcu.frame().channels[6] = 1.0F;
  fcu.rc_pass();
  EXPECT_TRUE(fcu.firmware().arming().armed());
}

TEST(FirmwareRcTest, ReportsEightChannelsInMicroseconds) {
  FakeBoard fcu(armable());
  fcu.frame().channels[0] = 0.1239F;
  fcu.frame().channels[1] = -0.2F;
  fcu.frame().channels[9] = 0.7F;
  fcu.wait(12345);
  fcu.rc_pass();
  const RcChannels message = fcu.sent<RcChannels>().back();
  EXPECT_EQ(message.time_boot_ms, 12U);
  EXPECT_EQ(message.chan_raw[0], 1123);
  EXPECT_EQ(message.chan_raw[1], 800);
  EXPECT_EQ(message.chan_raw[9], 0);
  EXPECT_EQ(message.chancount, 0);
}

TEST(FirmwareRcTest, KeepsSwitchesMappedWhenOnlyTheirNumberChanges) {
  FakeBoard fcu(armable());
  fcu.deliver(ParamSet{{bits_of(4)}, 1, 0, name_field("RC_NUM_CHN"), 6});
  EXPECT_TRUE(fcu.firmware().rc().mapped(Switch::kArm));
  fcu.deliver(ParamSet{{bits_of(5)}, 1, 0, name_field("RC_ARM_CHN"), 6});
  EXPECT_FALSE(fcu.firmware().rc().mapped(Switch::kArm));
}

// ---- telemetry ----

TEST(FirmwareTelemetryTest, StreamsWithTheScheduleOfTheLink) {
  FakeBoard fcu(armable());
  for (int k = 0; k < 800; ++k) {  // two seconds
    if (k % 4 == 0) fcu.board().mag = Triple{2e-5F, 0, 4e-5F};
    fcu.imu_pass();
  }
  EXPECT_EQ(fcu.sent<SmallImu>().size(), 800U);
  EXPECT_EQ(fcu.sent<AttitudeQuaternion>().size(), 800U);
  EXPECT_EQ(fcu.sent<SmallMag>().size(), 200U);
  EXPECT_EQ(fcu.sent<RosflightOutputRaw>().size(), 100U);
  EXPECT_EQ(fcu.sent<RosflightOutputRaw>()[0].stamp, 20U);
  EXPECT_EQ(fcu.sent<Heartbeat>().size(), 2U);
  EXPECT_EQ(fcu.sent<Heartbeat>()[0].type, 2);
  EXPECT_EQ(fcu.sent<Heartbeat>()[0].mavlink_version, 2);
  EXPECT_EQ(fcu.sent<RosflightStatus>().size(), 21U);  // one at boot
  EXPECT_TRUE(fcu.sent<SmallBaro>().empty());
}

TEST(FirmwareTelemetryTest, PutsTheAttitudeRightAfterItsImuSample) {
  FakeBoard fcu(armable());
  fcu.imu_passes(3);
  int pairs = 0;
  for (std::size_t k = 0; k + 1 < fcu.all_sent().size(); ++k) {
    const auto* imu = std::get_if<SmallImu>(&fcu.all_sent()[k].message);
    if (imu == nullptr) continue;
    const auto* attitude = std::get_if<AttitudeQuaternion>(&fcu.all_sent()[k + 1].message);
    ASSERT_NE(attitude, nullptr);
    EXPECT_EQ(attitude->time_boot_ms, imu->time_boot_us / 1000);
    ++pairs;
  }
  EXPECT_EQ(pairs, 3);
}

TEST(FirmwareTelemetryTest, SendsEverySlowSensorOnArrival) {
  FakeBoard fcu(armable());
  fcu.board().baro = PressureInput{89874.6F, 290.0F};
  fcu.board().differential_pressure = PressureInput{61.25F, 291.0F};
  fcu.board().range = 1.5F;
  fcu.board().battery = BatteryInput{20.0F, 3.0F};
  fcu.board().gnss = RosflightGnss{.lat = 40.0, .fix_type = 6};
  fcu.pass();
  EXPECT_NEAR(fcu.sent<SmallBaro>().at(0).altitude, 1000.0F, 1.0F);
  EXPECT_EQ(fcu.sent<SmallBaro>().at(0).pressure, 89874.6F);
  EXPECT_NEAR(fcu.sent<DiffPressure>().at(0).velocity, 10.0F, 1e-4F);
  EXPECT_EQ(fcu.sent<SmallRange>().at(0).max_range, 8.0F);
  EXPECT_EQ(fcu.sent<SmallRange>().at(0).min_range, 0.25F);
  EXPECT_NEAR(fcu.sent<RosflightBatteryStatus>().at(0).battery_voltage, 24.975F, 1e-4F);
  EXPECT_EQ(fcu.sent<RosflightGnss>().at(0).fix_type, 6);
}

TEST(FirmwareTelemetryTest, HoldsTextsUntilTheFirstHeartbeatAndReleasesOnePerPass) {
  FakeBoard fcu;
  fcu.pass();
  EXPECT_TRUE(fcu.sent<Statustext>().empty());
  fcu.deliver(Heartbeat{});
  EXPECT_TRUE(fcu.sent<Statustext>().empty()) << "texts leave before messages are read";
  for (std::size_t k = 1; k <= 5; ++k) {
    fcu.pass();
    EXPECT_EQ(fcu.sent<Statustext>().size(), k);  // a bad mixer and four switches
  }
  fcu.pass();
  EXPECT_EQ(fcu.sent<Statustext>().size(), 5U);
}

TEST(FirmwareTelemetryTest, KeepsTheLastTwentyFiveTexts) {
  FakeBoard fcu;
  for (int k = 0; k < 30; ++k) {
    fcu.deliver(ParamSet{{bits_of(k % 2 == 0 ? 6 : 7)}, 1, 0, name_field("RC_ARM_CHN"), 6});
  }
  fcu.put(Heartbeat{});
  for (int k = 0; k < 40; ++k) fcu.pass();
  EXPECT_EQ(fcu.sent<Statustext>().size(), 25U);
}

TEST(FirmwareTelemetryTest, WorksWithNobodyListening) {
  Firmware quiet(armable());
  FakeBoard loud(armable());
  Board board;
  for (int k = 0; k < 400; ++k) {
    board.clock_us += 2500;
    board.imu = ImuInput{
        .stamp_us = board.clock_us, .acceleration = {0.3F, 0, -9.7F}, .angular_velocity = {0, 0.1F, 0}};
    quiet.pass(board);
    loud.imu_pass({0.3F, 0, -9.7F}, {0, 0.1F, 0});
  }
  EXPECT_EQ(quiet.filter().attitude().pitch(), loud.firmware().filter().attitude().pitch());
  EXPECT_NE(quiet.filter().attitude().pitch(), 0.0F);
}

TEST(FirmwareTelemetryTest, SaysTheControlModeOfTheRollChannel) {
  FlyingBoard fcu;
  struct Row {
    std::uint8_t mode;
    int control_mode;
  };
  for (const Row row : {Row{0, 0}, Row{1, 1}, Row{2, 2}}) {
    fcu.put(OffboardControl{.u = {}, .ignore = 0, .mode = row.mode});
    fcu.rc_pass();  // reads the message, then combines
    fcu.rc_pass();
    fcu.wait(100000);
    fcu.pass();
    EXPECT_EQ(fcu.sent<RosflightStatus>().back().control_mode, row.control_mode);
    EXPECT_EQ(fcu.sent<RosflightStatus>().back().offboard, 1);
  }
}

// ---- samples that are no numbers ----

TEST(FirmwareTest, ControlsWithTheLastGoodSampleWhenOneIsAbsurd) {
  for (const float absurd : {1e30F, -1e30F, std::numeric_limits<float>::infinity()}) {
    FlyingBoard fcu;
    fcu.imu_passes(100);
    const auto before = fcu.board().outputs;
    fcu.imu_pass({absurd, 0, 0}, {});
    fcu.imu_pass({0, 0, -kGravity}, {0, absurd, 0});
    fcu.board().baro = PressureInput{.pressure = absurd};
    fcu.board().battery = BatteryInput{.voltage = absurd};
    fcu.imu_passes(400);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(fcu.board().outputs[k], before[k], 0.05F) << absurd;
    EXPECT_LT(std::fabs(fcu.firmware().battery().voltage()), 100.0F);
  }
}

TEST(FirmwareTest, LeavesTheOutputsAsTheyAreWhileTheImuIsSilentEvenWhenDisarmed) {
  FlyingBoard fcu;
  fcu.frame().channels[2] = 0.6F;
  fcu.rc_pass();
  fcu.imu_passes(10);
  const auto before = fcu.board().outputs;
  ASSERT_GT(before[0], 0.1F);
  // GIVEN no IMU sample, which is the heartbeat of the mixer, WHEN the pilot disarms
  fcu.frame().channels[4] = 0.0F;
  for (int i = 0; i < 100; ++i) {
    fcu.wait(20000);
    fcu.rc_pass();
  }
  EXPECT_FALSE(fcu.firmware().arming().armed());
  EXPECT_EQ(fcu.board().outputs, before) << "as the firmware on a real board: only the plug helps";
  // WHEN a sample comes THEN they stop
  fcu.imu_pass();
  EXPECT_EQ(fcu.board().outputs[0], 0.0F);
}

TEST(FirmwareTest, ControlsWithTheLastGoodSampleWhenOneIsNotANumber) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  FlyingBoard fcu;
  fcu.deliver(OffboardControl{.u = {0, 0, 0.5F, 0.1F, 0, 0}, .ignore = 0, .mode = 2});
  fcu.rc_pass();
  fcu.imu_passes(3);
  const auto before = fcu.board().outputs;
  fcu.board().baro = PressureInput{.pressure = kNan};
  fcu.imu_pass({kNan, kNan, kNan}, {kNan, kNan, kNan});
  EXPECT_TRUE(std::isnan(fcu.sent<SmallImu>().back().zacc));  // the companion sees what the chip said
  fcu.imu_pass();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_GT(before[k], 0.0F);
    EXPECT_NEAR(fcu.board().outputs[k], before[k], 0.05F);  // two ticks of the angle loop; a NaN fails
  }
}

// ---- determinism ----

TEST(FirmwareTest, RepeatsItselfToTheBit) {
  const auto fly = [] {
    FakeBoard fcu(armable());
    for (int k = 0; k < 1200; ++k) {
      const float t = 0.0025F * static_cast<float>(k);
      if (k % 4 == 0) fcu.rc_pass();
      if (k == 40) fcu.arm();
      fcu.deliver(
          OffboardControl{.u = {0, 0, 0.4F, 0.1F * std::sin(t), 0.05F, 0.0F}, .ignore = 0, .mode = 2});
      fcu.imu_pass({std::sin(3 * t), std::cos(2 * t), -9.8F}, {0.2F * std::cos(t), 0.1F, -0.1F});
    }
    return std::make_pair(fcu.board().outputs, fcu.sent<AttitudeQuaternion>());
  };
  const auto first = fly();
  const auto second = fly();
  EXPECT_EQ(first.first, second.first);
  ASSERT_EQ(first.second.size(), 1200U);
  for (std::size_t k = 0; k < first.second.size(); ++k) {
    ASSERT_EQ(bits_of(first.second[k].q2), bits_of(second.second[k].q2));
  }
}

TEST(FirmwareTest, RaisesUnhealthyEstimatorInFreeFallButKeepsFlying) {
  FlyingBoard fcu;
  for (int k = 0; k < 250; ++k) fcu.imu_pass({0, 0, 0});
  EXPECT_EQ(fcu.firmware().arming().errors(), kUnhealthyEstimator);
  EXPECT_TRUE(fcu.firmware().arming().armed());
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
