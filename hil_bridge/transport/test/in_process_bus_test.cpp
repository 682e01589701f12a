#include "hil_bridge/transport/in_process_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hil_bridge/transport/test/frame_bus_conformance.hpp"

namespace ironbird::hil_bridge::transport {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

class InProcessRig final : public BusRig {
 public:
  explicit InProcessRig(bool fd) : bus_({.fd = fd, .receive_queue = kReceiveQueue}) {
    for (FrameBus*& end : ends_) end = &bus_.attach();
  }
  FrameBus& end(int number) override { return *ends_[static_cast<std::size_t>(number)]; }
  bool wait() override {
    bus_.advance(now_ += milliseconds(10));
    return --patience_ > 0;
  }
  void patience() override { patience_ = 10; }
  void drive_off() override {
    bus_.short_circuit(true);
    end(0).send({.identifier = 1});
  }
  void restart() override {
    bus_.short_circuit(false);
    bus_.restart(end(0));
  }
  int receive_queue() const override { return kReceiveQueue; }

 private:
  static constexpr int kReceiveQueue = 256;
  InProcessBus bus_;
  FrameBus* ends_[3] = {};
  Time now_{0};
  int patience_ = 0;
};

INSTANTIATE_TEST_SUITE_P(InProcess, FrameBusConformance,
                         ::testing::Values(RigCase{
                             "Bus", [](bool fd) { return std::make_unique<InProcessRig>(fd); }}),
                         [](const auto& param) { return param.param.name; });

class InProcessBusTest : public ::testing::Test {
 protected:
  static std::vector<ReceivedFrame> all(FrameBus& bus) {
    std::vector<ReceivedFrame> frames;
    while (const auto frame = bus.receive()) frames.push_back(*frame);
    return frames;
  }
  static std::vector<BusEventKind> events(FrameBus& bus) {
    std::vector<BusEventKind> kinds;
    while (const auto event = bus.take_event()) kinds.push_back(event->kind);
    return kinds;
  }

  InProcessBus bus_;
  FrameBus& a_ = bus_.attach();
  FrameBus& b_ = bus_.attach();
  FrameBus& c_ = bus_.attach();
};

TEST_F(InProcessBusTest, TakesTheTimeThatAWireTakes) {
  a_.send(numbered(0x100, 8));
  a_.send(numbered(0x100, 0));
  bus_.advance(microseconds(130));
  EXPECT_TRUE(all(b_).empty());
  bus_.advance(milliseconds(1));
  const std::vector<ReceivedFrame> frames = all(b_);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].stamp, microseconds(131));
  EXPECT_EQ(frames[1].stamp, microseconds(131 + 67));
}

TEST_F(InProcessBusTest, SendsTheMoreUrgentFirst) {
  bus_.advance(milliseconds(1));
  a_.send(numbered(0x1F000000, 1));
  b_.send(numbered(0x10000000, 1));
  b_.send(numbered(0x1FFFFFFF, 1));
  c_.send(numbered(0x7FF, 1, false));
  FrameBus& listener = bus_.attach();
  bus_.advance(milliseconds(10));
  std::vector<std::uint32_t> order;
  for (const ReceivedFrame& frame : all(listener)) order.push_back(frame.frame.identifier);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0x10000000, 0x1F000000, 0x7FF, 0x1FFFFFFF}));
}

TEST_F(InProcessBusTest, DoesNotInterruptAFrameForAMoreUrgentOne) {
  a_.send(numbered(0x1F000000, 8));
  bus_.advance(microseconds(50));
  b_.send(numbered(0x1, 0));
  bus_.advance(milliseconds(1));
  EXPECT_EQ(all(c_)[0].frame.identifier, 0x1F000000U);
}

TEST_F(InProcessBusTest, RepeatsABrokenFrameAndTellsOnce) {
  bus_.corrupt_next(3);
  a_.send(numbered(0x100, 8));
  bus_.advance(milliseconds(1));
  const std::vector<ReceivedFrame> frames = all(b_);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp, microseconds(4 * 131 + 3 * 20));
  EXPECT_EQ(events(a_), std::vector{BusEventKind::kBusError});
}

TEST_F(InProcessBusTest, LosesAFrameWithoutAWord) {
  bus_.lose_next(1);
  a_.send(numbered(0x100, 8));
  a_.send(numbered(0x101, 8));
  bus_.advance(milliseconds(1));
  EXPECT_EQ(all(b_).at(0).frame.identifier, 0x101U);
  EXPECT_TRUE(events(a_).empty());
}

TEST_F(InProcessBusTest, GoesPassiveAfter16ErrorsAndOffAfter32) {
  bus_.corrupt_next(31);
  a_.send(numbered(0x100, 8));
  bus_.advance(milliseconds(20));
  EXPECT_EQ(a_.state(), BusState::kPassive);
  EXPECT_EQ(all(b_).size(), 1U);
  EXPECT_EQ(events(a_),
            (std::vector{BusEventKind::kBusError, BusEventKind::kWarning, BusEventKind::kPassive}));
  for (int k = 0; k < 200; ++k) {
    a_.send(numbered(0x100, 0));
    bus_.advance(milliseconds(30 + k));
  }
  EXPECT_EQ(a_.state(), BusState::kActive);
  EXPECT_EQ(events(a_), (std::vector{BusEventKind::kWarning, BusEventKind::kActive}));
  all(b_);
  bus_.corrupt_next(32);
  a_.send(numbered(0x100, 8));
  bus_.advance(milliseconds(300));
  EXPECT_EQ(a_.state(), BusState::kOff);
  EXPECT_TRUE(all(b_).empty()) << "a controller that is off forgets its frames";
  EXPECT_FALSE(a_.send(numbered(0x100, 8)));
}

TEST_F(InProcessBusTest, StaysPassiveWhenItIsAlone) {
  bus_.plug(b_, false);
  bus_.plug(c_, false);
  a_.send(numbered(0x100, 8));
  bus_.advance(std::chrono::seconds(1));
  EXPECT_EQ(a_.state(), BusState::kPassive);
  EXPECT_EQ(events(a_),
            (std::vector{BusEventKind::kNoAcknowledge, BusEventKind::kWarning, BusEventKind::kPassive}));
  bus_.plug(b_, true);
  bus_.advance(std::chrono::seconds(2));
  EXPECT_EQ(all(b_).size(), 1U) << "the frame was repeated until somebody heard it";
}

TEST(InProcessBusRestartTest, ComesBackByItselfAfterTheDelay) {
  InProcessBus bus({.restart_delay = milliseconds(100)});
  FrameBus& a = bus.attach();
  bus.attach();
  bus.corrupt_next(32);
  a.send(numbered(0x100, 8));
  bus.advance(milliseconds(50));
  EXPECT_EQ(a.state(), BusState::kOff);
  bus.advance(milliseconds(200));
  EXPECT_EQ(a.state(), BusState::kActive);
}

std::vector<std::int64_t> stamps_of_a_noisy_bus(std::uint64_t seed, Time step) {
  InProcessBus bus({.corruption = 0.05, .loss = 0.1, .seed = seed});
  FrameBus& a = bus.attach();
  FrameBus& b = bus.attach();
  std::vector<std::int64_t> stamps;
  for (Time now = milliseconds(5); now <= std::chrono::seconds(1); now += milliseconds(5)) {
    for (int k = 0; k < 10; ++k) a.send(numbered(0x100, k % 9));
    for (Time part = now - milliseconds(5) + step; part <= now; part += step) bus.advance(part);
    while (const auto frame = b.receive()) stamps.push_back(frame->stamp.count());
  }
  return stamps;
}

TEST(InProcessBusNoiseTest, IsTheSameForTheSameSeedHoweverTimeIsCut) {
  const std::vector<std::int64_t> once = stamps_of_a_noisy_bus(1, milliseconds(5));
  EXPECT_EQ(once, stamps_of_a_noisy_bus(1, microseconds(100)));
  EXPECT_NE(once, stamps_of_a_noisy_bus(2, milliseconds(5)));
  // 2000 frames, of which a tenth is lost: four standard deviations are 54.
  EXPECT_NEAR(static_cast<double>(once.size()), 1800.0, 54.0);
}

TEST(InProcessBusParamsTest, RefusesASpeedThatNoBusHas) {
  try {
    InProcessBus bus({.bit_rate = 0.0});
    FAIL() << "it was taken";
  } catch (const std::invalid_argument& problem) {
    EXPECT_THAT(problem.what(), ::testing::HasSubstr("in_process_bus.bit_rate"));
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::transport
