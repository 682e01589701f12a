#include "hil_bridge/virtual_fcu/rc.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
