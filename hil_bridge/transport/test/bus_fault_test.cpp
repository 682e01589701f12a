#include "hil_bridge/transport/bus_fault.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::transport {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t kIdentifier = 0x0804060A;

CanFrame counted_frame(int number) {
  CanFrame frame;
  frame.identifier = kIdentifier;
  frame.size = 2;
  frame.data[0] = static_cast<std::uint8_t>(number & 0xFF);
  frame.data[1] = static_cast<std::uint8_t>(number >> 8);
  return frame;
}
int number_of(const CanFrame& frame) {
  return frame.data[0] + 256 * frame.data[1];
}

/// A bus with faults at one end, and another end that has none.
class FaultyBus {
 public:
  explicit FaultyBus(const LinkFaultConfig& faults, std::uint64_t seed = 1)
      : fault_(bus_.attach(), faults, seed), peer_(&bus_.attach()) {}

  /// A millisecond passes: longer than a frame takes.
  void advance() {
    now_ += milliseconds(1);
    fault_.advance(now_);
    bus_.advance(now_);
    fault_.advance(now_);
  }
  std::vector<CanFrame> sent(int count) {
    std::vector<CanFrame> heard;
    for (int k = 0; k < count + 100; ++k) {
      if (k < count) fault_.send(counted_frame(k));
      advance();
      while (const auto frame = peer_->receive()) heard.push_back(frame->frame);
    }
    return heard;
  }
  std::vector<CanFrame> received(int count) {
    std::vector<CanFrame> heard;
    for (int k = 0; k < count + 100; ++k) {
      if (k < count) peer_->send(counted_frame(k));
      advance();
      while (const auto frame = fault_.receive()) heard.push_back(frame->frame);
    }
    return heard;
  }
  BusFault& fault() { return fault_; }
  FrameBus& peer() { return *peer_; }

 private:
  InProcessBus bus_;
  BusFault fault_;
  FrameBus* peer_;
  Time now_{0};
};

constexpr int kFaultFrames = 5000;

TEST(BusFaultTest, ChangesNothingWithoutFaults) {
  FaultyBus bus({});
  for (const auto& frames : {bus.sent(200), bus.received(200)}) {
    ASSERT_EQ(frames.size(), 200U);
    for (int k = 0; k < 200; ++k) EXPECT_EQ(frames[static_cast<std::size_t>(k)], counted_frame(k));
  }
}

TEST(BusFaultTest, LosesTheShareOfFramesThatItSaysInEachDirection) {
  const double deviation = 3.0 * std::sqrt(kFaultFrames * 0.2 * 0.8);
  FaultyBus bus({{.drop = 0.2}, {.drop = 0.2}});
  EXPECT_NEAR(static_cast<double>(bus.sent(kFaultFrames).size()), 0.8 * kFaultFrames, deviation);
  EXPECT_NEAR(static_cast<double>(bus.received(kFaultFrames).size()), 0.8 * kFaultFrames, deviation);
}

TEST(BusFaultTest, MakesTheSameDecisionsAsALineOfItsSeedAndName) {
  FaultyBus bus({{.drop = 0.3}, {}}, 7);
  std::vector<int> through;
  for (const CanFrame& frame : bus.sent(300)) through.push_back(number_of(frame));
  FaultyDirection line({.drop = 0.3}, 7, "bus/outgoing");
  std::vector<int> expected;
  for (int k = 0; k < 300; ++k) {
    const std::uint8_t byte = 0;
    line.put({&byte, 1}, milliseconds(k));
    if (line.due(milliseconds(k)) == nullptr) continue;
    line.pop();
    expected.push_back(k);
  }
  EXPECT_EQ(through, expected);
}

TEST(BusFaultTest, SpoilsFramesButHandsOnOnlyWhatABusCanCarry) {
  FaultyBus bus({{.corrupt = 0.05}, {}});
  const std::vector<CanFrame> frames = bus.sent(kFaultFrames);
  int spoilt = 0;
  for (const CanFrame& frame : frames) {
    EXPECT_TRUE(can::is_sendable(frame));
    spoilt += frame.identifier != kIdentifier || frame.size != 2 ? 1 : 0;
  }
  EXPECT_GT(spoilt, kFaultFrames / 20);
  EXPECT_LT(frames.size(), static_cast<std::size_t>(kFaultFrames));
}

TEST(BusFaultTest, InsertsFramesThatNobodySentAndSendsFramesTwice) {
  FaultyBus noisy({{}, {.insert = 1.0}});
  const std::vector<CanFrame> frames = noisy.received(100);
  ASSERT_EQ(frames.size(), 200U);
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(number_of(frames[2 * k + 1]), static_cast<int>(k));
  EXPECT_EQ(FaultyBus({{.duplicate = 1.0}, {}}).sent(100).size(), 200U);
}

TEST(BusFaultTest, DelaysReordersAndStandsStill) {
  FaultyBus late({{.latency = milliseconds(20)}, {}});
  late.fault().send(counted_frame(1));
  for (int k = 0; k < 19; ++k) late.advance();
  EXPECT_FALSE(late.peer().receive());
  late.advance();
  EXPECT_TRUE(late.peer().receive());

  const std::vector<CanFrame> mixed = FaultyBus({{.reorder = 0.2, .latency = milliseconds(3)}, {}}).sent(500);
  ASSERT_EQ(mixed.size(), 500U);
  int passed = 0;
  for (std::size_t k = 1; k < mixed.size(); ++k)
    passed += number_of(mixed[k]) < number_of(mixed[k - 1]) ? 1 : 0;
  EXPECT_GT(passed, 50);

  FaultyBus still({});
  still.fault().stand_still(milliseconds(50));
  still.fault().send(counted_frame(1));
  for (int k = 0; k < 49; ++k) still.advance();
  EXPECT_FALSE(still.peer().receive());
  still.advance();
  EXPECT_TRUE(still.peer().receive());
}

TEST(BusFaultTest, IsDownWhileItIsCutAndUpAgainByItself) {
  FaultyBus bus({});
  bus.advance();
  bus.fault().hang_up(milliseconds(11));
  EXPECT_EQ(bus.fault().state(), BusState::kDown);
  EXPECT_EQ(bus.fault().take_event()->kind, BusEventKind::kDown);
  EXPECT_FALSE(bus.fault().send(counted_frame(1)));
  bus.peer().send(counted_frame(2));
  for (int k = 0; k < 9; ++k) bus.advance();
  EXPECT_FALSE(bus.fault().take_event());
  bus.advance();
  EXPECT_EQ(bus.fault().take_event()->kind, BusEventKind::kUp);
  EXPECT_FALSE(bus.fault().receive());
  EXPECT_TRUE(bus.fault().send(counted_frame(3)));
  bus.advance();
  EXPECT_EQ(number_of(bus.peer().receive()->frame), 3);
}

TEST(BusFaultTest, RefusesProbabilitiesBeyondOne) {
  InProcessBus bus;
  EXPECT_THROW(BusFault(bus.attach(), {{.drop = 1.5}, {}}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
