#include "hil_bridge/can/frame_outbox.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hil_bridge/transport/in_process_bus.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class FrameOutboxTest : public ::testing::Test {
 protected:
  bool put(int priority, std::size_t size, Time deadline = seconds(9)) {
    const std::vector<std::uint8_t> payload(size, static_cast<std::uint8_t>(priority));
    const auto p = static_cast<std::uint8_t>(priority);
    return outbox_.put({p, TransferKind::kMessage, 1000, 20, 0, next_++}, 0, payload, false, deadline);
  }
  /// Priorities of what arrives, one for each frame.
  std::vector<int> sent(Time now) {
    std::vector<int> priorities;
    bus_.advance(now);
    while (const auto frame = other_.receive())
      priorities.push_back(static_cast<int>(frame->frame.identifier >> 24U));
    return priorities;
  }

  transport::InProcessBus bus_{{.send_queue = 4}};
  transport::FrameBus& end_ = bus_.attach();
  transport::FrameBus& other_ = bus_.attach();
  FrameOutbox outbox_;
  std::uint8_t next_ = 0;
};

TEST_F(FrameOutboxTest, SendsTheMoreUrgentFirstAndEqualOnesInTheirOrder) {
  put(24, 12);  // two frames
  put(7, 7);
  put(24, 7);
  put(7, 12);
  std::vector<int> all;
  for (Time now{0}; now < milliseconds(10); now += milliseconds(1)) {
    outbox_.flush(now, end_);
    for (const int priority : sent(now + milliseconds(1))) all.push_back(priority);
  }
  EXPECT_EQ(all, (std::vector<int>{7, 7, 7, 24, 24, 24}));
}

TEST_F(FrameOutboxTest, KeepsWhatTheBusDoesNotTakeYet) {
  put(16, 6 * 7 - 2);
  outbox_.flush(Time(0), end_);
  EXPECT_EQ(outbox_.size(), 2U);
  EXPECT_EQ(sent(milliseconds(1)).size(), 4U);
  outbox_.flush(milliseconds(1), end_);
  EXPECT_EQ(sent(milliseconds(2)).size(), 2U);
}

TEST_F(FrameOutboxTest, DropsWhatComesTooLate) {
  put(7, 7, milliseconds(5));
  put(8, 7, milliseconds(50));
  outbox_.flush(milliseconds(6), end_);
  EXPECT_EQ(sent(milliseconds(10)), std::vector<int>{8});
  EXPECT_EQ(outbox_.expired(), 1U);
}

TEST_F(FrameOutboxTest, TakesATransferWholeOrNotAtAll) {
  while (put(16, 400)) {
  }
  const std::size_t full = outbox_.size();
  EXPECT_LE(full, FrameOutbox::kCapacity);
  EXPECT_EQ(outbox_.refused(), 1U);
  EXPECT_FALSE(put(1, 400));
  EXPECT_EQ(outbox_.size(), full);
  EXPECT_TRUE(put(1, 7));
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
