// The unit's end of a line: who its frames say that they come from, and what a queue that is full drops.

#include "hil_bridge/virtual_fcu/served_fcu.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/transport/stream_pair.hpp"
#include "hil_bridge/virtual_fcu/firmware_host.hpp"

namespace ironbird::hil_bridge {
namespace {

using rosflight::Address;
using rosflight::Frame;

constexpr Time kServedTick = std::chrono::microseconds(2500);
constexpr Address kCompanion{37, 50};
constexpr std::uint8_t kFirmware = 250;

/// A unit on a board that feels nothing, at the far end of a line.
class Unit final : public Fcu {
 public:
  void advance(Time now) override { host_.tick({}, now); }
  void receive(std::vector<Arrival>& out) override { host_.receive(out); }
  void send(const rosflight::Message& message) override { host_.send(message); }
  Time now() const { return host_.now(); }

 private:
  FirmwareHost host_{VirtualFcuConfig{}};
};

class ServedFcuTest : public testing::Test {
 protected:
  explicit ServedFcuTest(std::size_t room = 1U << 16U) : pair_(room), served_(unit_, pair_.far()) {}

  void say(const rosflight::Message& message) {
    const rosflight::FrameBytes frame = rosflight::encode_frame(message, sequence_++, kCompanion);
    pair_.near().write(std::span(frame.bytes).first(frame.size));
  }
  void pass(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      served_.take();
      unit_.advance(unit_.now() + kServedTick);
      served_.give();
    }
  }
  /// What has come over the line since.
  std::vector<Frame> heard() {
    std::vector<std::uint8_t> bytes(1U << 17U);
    bytes.resize(pair_.near().read(bytes));
    std::vector<Frame> frames;
    decoder_.push(bytes, [&](const Frame& frame) { frames.push_back(frame); });
    return frames;
  }
  template <class Content>
  std::vector<Frame> heard_of() {
    std::vector<Frame> frames;
    for (const Frame& frame : heard()) {
      if (std::holds_alternative<Content>(frame.message)) frames.push_back(frame);
    }
    return frames;
  }

  Unit unit_;
  transport::StreamPair pair_;
  ServedFcu served_;
  rosflight::StreamDecoder decoder_;
  std::uint8_t sequence_ = 0;
};

TEST_F(ServedFcuTest, CountsItsFramesWithoutAGapAndSignsThemWithItsNumber) {
  pass(1000);
  const std::vector<Frame> frames = heard();
  ASSERT_GT(frames.size(), 256U);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].sequence, static_cast<std::uint8_t>(k));
    EXPECT_EQ(frames[k].sender.system, 1);
    EXPECT_EQ(frames[k].sender.component, kFirmware);
  }
}

TEST_F(ServedFcuTest, SignsParametersWithComponentZero) {
  say(rosflight::ParamRequestList{.target_system = 1});
  pass(1000);
  const std::vector<Frame> values = heard_of<rosflight::ParamValue>();
  EXPECT_EQ(values.size(), 333U);
  for (const Frame& value : values) {
    EXPECT_EQ(value.sender.system, 1);
    EXPECT_EQ(value.sender.component, 0);
  }
}

TEST_F(ServedFcuTest, SignsTextsThatItHeldBackWithTheLowByteOfItsClock) {
  // GIVEN texts from before the first heartbeat: of an order that is refused without data of sensors
  say(rosflight::RosflightCmd{.command = rosflight::kCalibrateAirspeed});
  pass(20);
  ASSERT_TRUE(heard_of<rosflight::Statustext>().empty());
  say(rosflight::Heartbeat{});
  const Time connected = unit_.now() + kServedTick;
  pass(1);
  const std::vector<Frame> texts = heard_of<rosflight::Statustext>();
  ASSERT_FALSE(texts.empty());
  const auto clock = static_cast<std::uint64_t>(connected.count() / 1000);
  EXPECT_EQ(texts.front().sender.system, static_cast<std::uint8_t>(clock));
  EXPECT_EQ(texts.front().sender.component, kFirmware);
}

TEST_F(ServedFcuTest, SignsTheAnswerToAnUnknownOrderWithTheAskersNumber) {
  pass(2);
  heard();
  say(rosflight::RosflightCmd{.command = 99});
  pass(2);
  say(rosflight::RosflightCmd{.command = rosflight::kSendVersion});
  pass(2);
  const std::vector<Frame> answers = heard_of<rosflight::RosflightCmdAck>();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].sender.system, kCompanion.system);
  EXPECT_EQ(answers[1].sender.system, 1);
}

TEST_F(ServedFcuTest, SignsWithItsNewNumberOnceItWasGivenOne) {
  say(rosflight::ParamSet{.param_value = {std::bit_cast<std::uint32_t>(9)},
                          .target_system = 1,
                          .param_id = rosflight::field_of<16>("SYS_ID"),
                          .param_type = 6});
  pass(400);
  heard();
  pass(400);
  const std::vector<Frame> frames = heard();
  ASSERT_GT(frames.size(), 50U);
  for (const Frame& frame : frames) EXPECT_EQ(frame.sender.system, 9);
  say(rosflight::ParamRequestList{.target_system = 1});
  pass(400);
  EXPECT_TRUE(heard_of<rosflight::ParamValue>().empty()) << "it does not hear its old number";
}

class FullLineTest : public ServedFcuTest {
 protected:
  FullLineTest() : ServedFcuTest(100) {}
};

TEST_F(FullLineTest, DropsNewPacketsWholeAndCountsThem) {
  pass(4000);
  EXPECT_GT(served_.dropped(), 500U);
  EXPECT_FALSE(served_.all_given());
  // THEN what was kept is whole and of before the queue was full, and after it the count of frames shows a
  // gap.
  std::vector<Frame> frames;
  for (int k = 0; k < 400; ++k) {
    for (const Frame& frame : heard()) frames.push_back(frame);
    served_.give();
  }
  ASSERT_GT(frames.size(), 100U);
  EXPECT_EQ(decoder_.counts().corrupted, 0U);
  EXPECT_EQ(decoder_.counts().skipped_bytes, 0U);
  EXPECT_TRUE(served_.all_given());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].sequence, static_cast<std::uint8_t>(k));
  }
  pass(400);
  const std::vector<Frame> next = heard();
  ASSERT_FALSE(next.empty());
  EXPECT_NE(next.front().sequence, static_cast<std::uint8_t>(frames.size()));
}

}  // namespace
}  // namespace ironbird::hil_bridge
