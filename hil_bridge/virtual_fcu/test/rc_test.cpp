#include "hil_bridge/virtual_fcu/rc.hpp"

#include <gtest/gtest.h>

#include "hil_bridge/virtual_fcu/command_mux.hpp"

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr std::uint32_t kFrameMs = 10;

class RcTest : public ::testing::Test {
 protected:
  RcTest() {
    frame.channels.fill(0.5F);
    frame.channels[2] = 0.0F;
    apply();
  }
  void apply() {
    rc.configure(parameters);
    rc.map_switches(parameters);
  }
  Rc::Request decode(bool armed = false) { return rc.decode(frame, now += kFrameMs, armed); }

  ParameterStore parameters;
  Rc rc;
  RcFrame frame;
  std::uint32_t now = 0;
};

TEST_F(RcTest, MapsSticksWithoutDeadBand) {
  frame.channels[0] = 0.75F;
  frame.channels[1] = 0.0F;
  frame.channels[2] = 0.3F;
  frame.channels[3] = 0.501F;
  decode();
  EXPECT_FLOAT_EQ(rc.sticks().x, 0.5F);
  EXPECT_FLOAT_EQ(rc.sticks().y, -1.0F);
  EXPECT_FLOAT_EQ(rc.sticks().throttle, 0.3F);
  EXPECT_FLOAT_EQ(rc.sticks().z, 2.0F * (0.501F - 0.5F));
}

TEST_F(RcTest, LosesAFrameForItsFlagsOrForOneChannelOutOfRange) {
  EXPECT_FALSE(rc.lost(frame));
  frame.channels[3] = 1.25F;
  frame.channels[2] = -0.25F;
  EXPECT_FALSE(rc.lost(frame)) << "the bounds themselves are valid";
  frame.channels[5] = 1.26F;
  EXPECT_TRUE(rc.lost(frame));
  frame.channels[5] = -0.26F;
  EXPECT_TRUE(rc.lost(frame));
  frame.channels[5] = 0.5F;
  frame.channels[6] = 9.0F;
  EXPECT_FALSE(rc.lost(frame)) << "channel 6 is beyond RC_NUM_CHN 6";
  frame.frame_lost = true;
  EXPECT_TRUE(rc.lost(frame));
  frame.frame_lost = false;
  frame.failsafe = true;
  EXPECT_TRUE(rc.lost(frame));
}

TEST_F(RcTest, MapsASwitchOnlyBetweenTheSticksAndTheLastChannel) {
  struct Row {
    int channel;
    bool mapped;
  };
  for (const Row row : {Row{-1, false}, Row{3, false}, Row{4, true}, Row{5, true}, Row{6, false}}) {
    parameters.set(parameter("RC_ARM_CHN"), row.channel);
    apply();
    EXPECT_EQ(rc.mapped(Switch::kArm), row.mapped) << row.channel;
  }
}

TEST_F(RcTest, TurnsASwitchOnAtItsEnd) {
  struct Row {
    int direction;
    float channel;
    bool on;
  };
  for (const Row row :
       {Row{1, 0.79F, false}, Row{1, 0.8F, true}, Row{-1, 0.19F, true}, Row{-1, 0.2F, false}}) {
    parameters.set(parameter("SWITCH_5_DIR"), row.direction);
    apply();
    frame.channels[4] = row.channel;
    decode();
    EXPECT_EQ(rc.on(Switch::kAttitudeOverride), row.on) << row.direction << " " << row.channel;
  }
}

TEST_F(RcTest, AsksToArmAfterMoreThanASecondInTheCorner) {
  frame.channels[3] = 1.0F;  // yaw right, throttle low
  int frames = 0;
  while (decode() == Rc::Request::kNone) ++frames;
  EXPECT_EQ(frames, 100);  // 1000 ms are not yet more than 1000 ms
  EXPECT_EQ(decode(), Rc::Request::kArm) << "on every frame from then on";
}

TEST_F(RcTest, StartsTheGestureAnewWhenTheStickLeavesTheCorner) {
  frame.channels[3] = 1.0F;
  for (int k = 0; k < 90; ++k) decode();
  frame.channels[3] = 0.5F;
  decode();
  frame.channels[3] = 1.0F;
  for (int k = 0; k < 90; ++k) EXPECT_EQ(decode(), Rc::Request::kNone);
}

TEST_F(RcTest, DisarmsWithTheOppositeCornerAndNeedsLowThrottle) {
  frame.channels[3] = 0.0F;
  frame.channels[2] = 0.2F;
  for (int k = 0; k < 150; ++k) EXPECT_EQ(decode(true), Rc::Request::kNone);
  frame.channels[2] = 0.1F;
  int frames = 0;
  while (decode(true) == Rc::Request::kNone) ++frames;
  EXPECT_EQ(frames, 100);
}

TEST_F(RcTest, ArmsAndDisarmsWithTheSwitchInEveryFrame) {
  parameters.set(parameter("RC_ARM_CHN"), 5);
  apply();
  frame.channels[5] = 1.0F;
  EXPECT_EQ(decode(false), Rc::Request::kArm);
  EXPECT_EQ(decode(false), Rc::Request::kArm);
  EXPECT_EQ(decode(true), Rc::Request::kNone);
  frame.channels[5] = 0.0F;
  frame.channels[2] = 0.9F;  // at any throttle
  EXPECT_EQ(decode(true), Rc::Request::kDisarm);
}

// ---- CommandMux ----

class CommandMuxTest : public RcTest {
 protected:
  CommandMuxTest() {
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
    apply();
    mux.configure(parameters);
    mux.rebuild_failsafe(parameters);
  }
  void update() {
    decode();
    mux.update(rc, now);
  }
  void command(std::uint8_t mode, std::array<float, 10> u, std::uint16_t ignore = 0) {
    mux.take({.u = u, .ignore = ignore, .mode = mode}, now);
  }

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
  while (now + kFrameMs < deviated + 1000) {
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
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
