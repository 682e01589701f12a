#include "hil_bridge/virtual_fcu/command_mux.hpp"

#include <gtest/gtest.h>

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr std::uint32_t kMuxFrameMs = 10;

class CommandMuxTest : public ::testing::Test {
 protected:
  CommandMuxTest() {
    frame.channels.fill(0.5F);
    frame.channels[2] = 0.0F;
    parameters.set(parameter("RC_NUM_CHN"), 8);
    parameters.set(parameter("RC_ATT_OVRD_CHN"), 4);
    parameters.set(parameter("RC_THR_OVRD_CHN"), 5);
    parameters.set(parameter("RC_ATT_CTRL_CHN"), 6);
    frame.channels[4] = frame.channels[5] = 0.0F;
    frame.channels[6] = 1.0F;
    now = 5000;  // the lag after boot is over
    configure();
  }
  void configure() {
    rc.configure(parameters);
    rc.map_switches(parameters);
    mux.configure(parameters);
    mux.rebuild_failsafe(parameters);
  }
  void update() {
    rc.decode(frame, now += kMuxFrameMs, false);
    mux.update(rc, now);
  }
  void command(std::uint8_t mode, std::array<float, 10> u, std::uint16_t ignore = 0) {
    mux.take({.u = u, .ignore = ignore, .mode = mode}, now);
  }

  ParameterStore parameters;
  Rc rc;
  RcFrame frame;
  std::uint32_t now = 0;
  CommandMux mux;
};

constexpr std::array<float, 10> kForces = {1, 2, -30, 0.1F, 0.2F, 0.3F, 6, 7, 8, 9};

TEST_F(CommandMuxTest, BootsUnderFullOverrideAndDropsTheStickBitsAfterTheLag) {
  now = 0;
  update();
  EXPECT_EQ(mux.overrides(), 0x3DC);
  now = 989;
  update();
  EXPECT_EQ(mux.overrides(), 0x3DC);
  update();
  EXPECT_EQ(mux.overrides(), 0x3C0) << "at 1009 ms";
}

TEST_F(CommandMuxTest, GivesTheCompanionFullAuthorityWithAFreshCommandAndCentredSticks) {
  command(0, kForces);
  update();
  EXPECT_EQ(mux.overrides(), 0);
  EXPECT_TRUE(mux.offboard());
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(mux.combined().u[i].value, kForces[i]);
    EXPECT_EQ(mux.combined().u[i].kind, ChannelKind::kPassThrough);
  }
}

TEST_F(CommandMuxTest, CallsItOffboardForForcesAndTorquesOnly) {
  command(0, kForces, 0x03F);
  update();
  EXPECT_FALSE(mux.offboard()) << "free inputs do not count";
  for (int i = 0; i < 6; ++i) {
    command(0, kForces, static_cast<std::uint16_t>(0x3FF & ~(1U << i)));
    EXPECT_TRUE(mux.offboard()) << i;
  }
}

struct ModeCase {
  std::uint8_t mode;
  ChannelKind force;
  ChannelKind roll;
  ChannelKind yaw;
};

TEST_F(CommandMuxTest, ReadsTheThreeModes) {
  using K = ChannelKind;
  for (const ModeCase& c :
       {ModeCase{0, K::kPassThrough, K::kPassThrough, K::kPassThrough},
        ModeCase{1, K::kThrottle, K::kRate, K::kRate}, ModeCase{2, K::kThrottle, K::kAngle, K::kRate}}) {
    command(c.mode, kForces);
    EXPECT_EQ(mux.companion().u[kForceZ].kind, c.force);
    EXPECT_EQ(mux.companion().u[kRoll].kind, c.roll);
    EXPECT_EQ(mux.companion().u[kPitch].kind, c.roll);
    EXPECT_EQ(mux.companion().u[kYaw].kind, c.yaw);
  }
}

TEST_F(CommandMuxTest, DropsOtherModesWithoutRefreshingTheTimeout) {
  command(0, kForces);
  now += 90;
  command(3, {});
  EXPECT_EQ(mux.companion().u[kForceZ].value, -30.0F);
  now += 1;
  update();  // 101 ms after the last command that counted
  EXPECT_EQ(mux.overrides() & 0x3C0, 0x3C0);
}

TEST_F(CommandMuxTest, TimesTheCompanionOutAfterMoreThanItsTimeoutAndOnlyWhenAsked) {
  command(0, kForces);
  now += 90;
  update();  // 100 ms
  EXPECT_TRUE(mux.offboard());
  now += 1000;
  EXPECT_TRUE(mux.offboard()) << "no RC frame, no judgement";
  update();
  EXPECT_FALSE(mux.offboard());
  EXPECT_EQ(mux.overrides(), 0x3C0);
  EXPECT_EQ(mux.combined().u[6].value, 6.0F) << "free inputs never time out";
}

TEST_F(CommandMuxTest, TakesIgnoredChannelsFromThePilot) {
  struct Row {
    int bit;
    std::uint16_t expected;
  };
  for (const Row row : {Row{2, 0x200}, Row{3, 0x040}, Row{4, 0x080}, Row{5, 0x100}, Row{0, 0}, Row{6, 0}}) {
    command(0, kForces, static_cast<std::uint16_t>(1U << row.bit));
    update();
    EXPECT_EQ(mux.overrides(), row.expected) << row.bit;
  }
}

TEST_F(CommandMuxTest, SwitchesOverrideAllOfAttitudeOrAllForces) {
  command(0, kForces);
  frame.channels[4] = 1.0F;
  update();
  EXPECT_EQ(mux.overrides(), 0x001);
  EXPECT_EQ(mux.combined().u[kYaw].kind, ChannelKind::kRate);
  EXPECT_EQ(mux.combined().u[kForceZ].value, -30.0F);
  frame.channels[4] = 0.0F;
  frame.channels[5] = 1.0F;
  update();
  EXPECT_EQ(mux.overrides(), 0x002);
  EXPECT_EQ(mux.combined().u[kYaw].value, 0.3F);
  EXPECT_EQ(mux.combined().u[kForceX].value, 0.0F) << "all three forces follow the throttle decision";
  EXPECT_EQ(mux.combined().u[kForceZ].kind, ChannelKind::kThrottle);
}

TEST_F(CommandMuxTest, TakesOneAxisPerDeviatedStickAndHoldsItForTheLag) {
  command(0, kForces);
  frame.channels[1] = 0.56F;  // 0.12 of full pitch stick
  update();
  EXPECT_EQ(mux.overrides(), 0x008);
  EXPECT_EQ(mux.combined().u[kPitch].kind, ChannelKind::kAngle);
  EXPECT_NEAR(mux.combined().u[kPitch].value, 0.12F * 0.786F, 1e-6F);
  EXPECT_EQ(mux.combined().u[kRoll].value, 0.1F);
  frame.channels[1] = 0.5F;
  const std::uint32_t deviated = now;
  while (now + kMuxFrameMs < deviated + 1000) {
    command(0, kForces);
    update();
    ASSERT_EQ(mux.overrides(), 0x008) << now - deviated;
  }
  update();
  EXPECT_EQ(mux.overrides(), 0) << "at 1000 ms";
}

TEST_F(CommandMuxTest, IgnoresAStickAtExactlyTheDeviation) {
  parameters.set(parameter("RC_OVRD_DEV"), 0.5F);
  configure();
  command(0, kForces);
  frame.channels[0] = 0.75F;
  update();
  EXPECT_EQ(mux.overrides(), 0);
}

TEST_F(CommandMuxTest, LetsTheLowerThrottleWinExceptInPassThrough) {
  frame.channels[2] = 0.4F;
  command(2, {0, 0, 0.5F});
  update();
  EXPECT_EQ(mux.overrides(), 0x020);
  EXPECT_EQ(mux.combined().u[kForceZ].value, 0.4F);
  command(2, {0, 0, 0.3F});
  update();
  EXPECT_EQ(mux.overrides(), 0);
  EXPECT_EQ(mux.combined().u[kForceZ].value, 0.3F);
  command(0, {0, 0, -100.0F});  // up-thrust is negative: the pilot's value is never the smaller
  frame.channels[2] = 0.0F;
  update();
  EXPECT_EQ(mux.overrides(), 0);
}

TEST_F(CommandMuxTest, TakesTheAttitudeModeFromTheSwitchOrTheParameter) {
  frame.channels[0] = 1.0F;
  frame.channels[6] = 0.0F;
  update();
  EXPECT_EQ(mux.pilot().u[kRoll].kind, ChannelKind::kRate);
  EXPECT_FLOAT_EQ(mux.pilot().u[kRoll].value, 3.14159F);
  parameters.set(parameter("RC_ATT_CTRL_CHN"), -1);
  configure();
  update();
  EXPECT_EQ(mux.pilot().u[kRoll].kind, ChannelKind::kAngle);
  EXPECT_FLOAT_EQ(mux.pilot().u[kRoll].value, 0.786F);
  EXPECT_EQ(mux.pilot().u[kYaw].kind, ChannelKind::kRate);
}

TEST_F(CommandMuxTest, ScalesEachStickByItsOwnLimit) {
  parameters.set(parameter("RC_MAX_ROLL"), 0.5F);
  parameters.set(parameter("RC_MAX_PITCH"), 0.6F);
  parameters.set(parameter("RC_MAX_ROLLRATE"), 2.0F);
  parameters.set(parameter("RC_MAX_PITCHRATE"), 3.0F);
  parameters.set(parameter("RC_MAX_YAWRATE"), 4.0F);
  configure();
  for (const std::size_t stick : {0U, 1U, 3U}) frame.channels[stick] = 1.0F;
  update();
  EXPECT_EQ(mux.pilot().u[kRoll].value, 0.5F);
  EXPECT_EQ(mux.pilot().u[kPitch].value, 0.6F);
  EXPECT_EQ(mux.pilot().u[kYaw].value, 4.0F);
  frame.channels[6] = 0.0F;
  update();
  EXPECT_EQ(mux.pilot().u[kRoll].value, 2.0F);
  EXPECT_EQ(mux.pilot().u[kPitch].value, 3.0F);
  EXPECT_EQ(mux.pilot().u[kYaw].value, 4.0F);
}

TEST_F(CommandMuxTest, PutsTheThrottleStickOnItsAxisAndJudgesThatAxis) {
  for (const int axis : {0, 1, 2}) {
    parameters.set(parameter("RC_F_AXIS"), axis);
    configure();
    frame.channels[2] = 0.4F;
    command(2, {0.5F, 0.5F, 0.5F}, static_cast<std::uint16_t>(1U << axis));
    update();
    EXPECT_EQ(mux.overrides(), kThrottleInactive | kMinimumThrottle) << axis;
    for (const int other : {0, 1, 2}) {
      EXPECT_EQ(mux.combined().u[static_cast<std::size_t>(other)].value, other == axis ? 0.4F : 0.0F);
    }
    std::array<float, 10> u{};
    u.fill(0.3F);
    command(2, u);
    update();
    EXPECT_EQ(mux.overrides(), 0) << axis;
  }
}

TEST_F(CommandMuxTest, PassesSticksStraightThroughForAFixedWing) {
  parameters.set(parameter("FIXED_WING"), 1);
  parameters.set(parameter("RC_F_AXIS"), 0);
  configure();
  frame.channels[0] = 1.0F;
  frame.channels[2] = 0.6F;
  update();
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(mux.pilot().u[i].kind, ChannelKind::kPassThrough);
  EXPECT_EQ(mux.pilot().u[kRoll].value, 1.0F);
  EXPECT_EQ(mux.pilot().u[kForceX].value, 0.6F);
}

TEST_F(CommandMuxTest, FliesLevelWithTheFailsafeThrottle) {
  parameters.set(parameter("FAILSAFE_THR"), 0.35F);
  configure();
  command(0, kForces);
  update();
  mux.fly_failsafe();
  EXPECT_EQ(mux.overrides(), 0) << "the override word stays as it was";
  EXPECT_EQ(mux.combined().u[kForceZ].value, 0.35F);
  EXPECT_EQ(mux.combined().u[kForceZ].kind, ChannelKind::kThrottle);
  EXPECT_EQ(mux.combined().u[kRoll].kind, ChannelKind::kAngle);
  EXPECT_EQ(mux.combined().u[kPitch].kind, ChannelKind::kAngle);
  EXPECT_EQ(mux.combined().u[kYaw].kind, ChannelKind::kRate);
  for (std::size_t i : {0U, 1U, 3U, 4U, 5U}) EXPECT_EQ(mux.combined().u[i].value, 0.0F);
  for (const Channel& channel : mux.combined().u) EXPECT_TRUE(channel.active);
}

TEST_F(CommandMuxTest, LetsAWingsFailsafePassZerosThrough) {
  parameters.set(parameter("FIXED_WING"), 1);
  parameters.set(parameter("FAILSAFE_THR"), 0.35F);
  configure();
  mux.fly_failsafe();
  for (const Channel& channel : mux.combined().u) {
    EXPECT_EQ(channel.kind, ChannelKind::kPassThrough);
    EXPECT_EQ(channel.value, 0.0F);
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
