#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hil_bridge/transport/frame_bus.hpp"

// What every FrameBus has to do, whatever is behind it. A rig makes three ends of one bus and lets its time
// pass.

namespace ironbird::hil_bridge::transport {

class BusRig {
 public:
  virtual ~BusRig() = default;
  virtual FrameBus& end(int number) = 0;  // 0, 1 or 2
  /// Lets a moment pass. @return false when that was the last one: what has not come by now never comes
  virtual bool wait() = 0;
  /// Begins the next wait with full patience.
  virtual void patience() = 0;
  /// Brings end 0 into a state of error by whatever means there are.
  virtual void drive_off() = 0;
  virtual void restart() = 0;
  /// Frames that an end keeps at least, and never more than.
  virtual int receive_queue() const = 0;
};

using MakeRig = std::function<std::unique_ptr<BusRig>(bool fd)>;

struct RigCase {
  const char* name;
  MakeRig make;
};

class FrameBusConformance : public ::testing::TestWithParam<RigCase> {
 protected:
  void SetUp() override { make(false); }
  void make(bool fd) {
    rig_.reset();
    rig_ = GetParam().make(fd);
  }
  FrameBus& end(int number) { return rig_->end(number); }

  std::optional<ReceivedFrame> next(FrameBus& bus) {
    rig_->patience();
    do {
      if (const std::optional<ReceivedFrame> frame = bus.receive()) return frame;
    } while (rig_->wait());
    return std::nullopt;
  }
  void send(FrameBus& bus, const CanFrame& frame) {
    rig_->patience();
    while (!bus.send(frame)) ASSERT_TRUE(rig_->wait()) << "the frame is not taken";
  }
  /// Waits for an event of that kind; others are passed over.
  std::optional<BusEvent> event(FrameBus& bus, BusEventKind kind) {
    rig_->patience();
    do {
      while (bus.receive()) {
      }
      while (const std::optional<BusEvent> event = bus.take_event()) {
        if (event->kind == kind) return event;
      }
    } while (rig_->wait());
    return std::nullopt;
  }

  std::unique_ptr<BusRig> rig_;
};

inline CanFrame numbered(std::uint32_t identifier, int size, bool extended = true) {
  CanFrame frame;
  frame.identifier = identifier;
  frame.extended = extended;
  frame.size = static_cast<std::uint8_t>(size);
  for (int k = 0; k < size; ++k)
    frame.data[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(0xA0 + k);
  return frame;
}

TEST_P(FrameBusConformance, CarriesClassicFramesOfEveryLengthToEveryOtherEnd) {
  for (int size = 0; size <= 8; ++size) {
    const CanFrame frame = numbered(0x1234567U + static_cast<unsigned>(size), size);
    send(end(0), frame);
    for (const int receiver : {1, 2}) {
      const std::optional<ReceivedFrame> arrived = next(end(receiver));
      ASSERT_TRUE(arrived.has_value());
      EXPECT_EQ(arrived->frame, frame);
    }
  }
}

TEST_P(FrameBusConformance, TellsShortIdentifiersFromLongOnes) {
  send(end(0), numbered(0x123, 2, false));
  send(end(0), numbered(0x123, 2, true));
  EXPECT_FALSE(next(end(1))->frame.extended);
  EXPECT_TRUE(next(end(1))->frame.extended);
}

TEST_P(FrameBusConformance, CarriesRequestsForFrames) {
  CanFrame request = numbered(0x55, 0);
  request.remote = true;
  send(end(0), request);
  EXPECT_EQ(next(end(1))->frame, request);
}

TEST_P(FrameBusConformance, CarriesCanFdFramesOfEveryLength) {
  make(true);
  ASSERT_TRUE(end(0).fd());
  for (int size = 0; size <= 64; ++size) {
    CanFrame frame = numbered(0x1ABCDEF, size);
    frame.fd = true;
    frame.bit_rate_switch = size % 2 == 0;
    if (!can::is_sendable(frame)) {
      EXPECT_FALSE(end(0).send(frame)) << size;
      continue;
    }
    send(end(0), frame);
    EXPECT_EQ(next(end(1))->frame, frame);
  }
}

TEST_P(FrameBusConformance, CarriesClassicFramesAmongThoseOfCanFd) {
  make(true);
  CanFrame wide = numbered(7, 64);
  wide.fd = true;
  send(end(0), numbered(6, 8));
  send(end(0), wide);
  EXPECT_FALSE(next(end(1))->frame.fd);
  EXPECT_TRUE(next(end(1))->frame.fd);
}

TEST_P(FrameBusConformance, RefusesWhatTheBusCannotCarryAndCountsIt) {
  CanFrame wide = numbered(7, 8);
  wide.fd = true;
  CanFrame error = numbered(0x40, 8);
  error.error = true;
  EXPECT_FALSE(end(0).send(wide));
  EXPECT_FALSE(end(0).send(error));
  EXPECT_FALSE(end(0).send(numbered(0x20000000U, 1)));
  EXPECT_FALSE(end(0).send(numbered(0x800, 1, false)));
  EXPECT_EQ(end(0).counters().refused, 4U);
  EXPECT_EQ(end(0).counters().sent, 0U);
}

TEST_P(FrameBusConformance, KeepsTheOrderOfOneSender) {
  constexpr int kFrames = 200;
  for (int k = 0; k < kFrames; ++k) {
    CanFrame frame = numbered(0x100, 1);
    frame.data[0] = static_cast<std::uint8_t>(k);
    send(end(0), frame);
    if (k % 50 == 49) rig_->wait();
  }
  for (int k = 0; k < kFrames; ++k) {
    const std::optional<ReceivedFrame> arrived = next(end(1));
    ASSERT_TRUE(arrived.has_value()) << k;
    EXPECT_EQ(arrived->frame.data[0], k);
  }
}

TEST_P(FrameBusConformance, DoesNotHearItself) {
  send(end(0), numbered(1, 1));
  send(end(1), numbered(2, 1));
  EXPECT_EQ(next(end(0))->frame.identifier, 2U);
  EXPECT_FALSE(end(0).receive().has_value());
}

TEST_P(FrameBusConformance, ReturnsAtOnceWhenThereIsNothing) {
  EXPECT_FALSE(end(0).receive().has_value());
  EXPECT_FALSE(end(0).take_event().has_value());
  EXPECT_EQ(end(0).state(), BusState::kActive);
}

TEST_P(FrameBusConformance, StampsFramesInTheOrderInWhichTheyCome) {
  Time last{-1};
  for (int k = 0; k < 20; ++k) {
    send(end(0), numbered(0x100, 8));
    const std::optional<ReceivedFrame> arrived = next(end(1));
    ASSERT_TRUE(arrived.has_value());
    EXPECT_GT(arrived->stamp, last);
    last = arrived->stamp;
  }
}

TEST_P(FrameBusConformance, LetsThroughWhatPassesOneOfTheFilters) {
  end(1).set_filters(std::array{FrameFilter{0x100, 0x1FFFFF00, true}, FrameFilter{0x20, 0x7FF, false}});
  send(end(0), numbered(0x1FF, 1));        // passes the first
  send(end(0), numbered(0x200, 1));        // another identifier
  send(end(0), numbered(0x20, 1, false));  // passes the second
  send(end(0), numbered(0x20, 1, true));   // of another length
  send(end(0), numbered(0x101, 1, false));
  send(end(0), numbered(0x100, 1));  // passes the first
  EXPECT_EQ(next(end(1))->frame.identifier, 0x1FFU);
  EXPECT_EQ(next(end(1))->frame.identifier, 0x20U);
  EXPECT_EQ(next(end(1))->frame.identifier, 0x100U);
  EXPECT_EQ(next(end(2))->frame.identifier, 0x1FFU) << "another end has its own filters";
  end(1).set_filters({});
  send(end(0), numbered(0x200, 1));
  EXPECT_EQ(next(end(1))->frame.identifier, 0x200U);
}

TEST_P(FrameBusConformance, CountsWhatWasNotFetchedInTime) {
  const int frames = rig_->receive_queue() * 2;
  for (int k = 0; k < frames; ++k) {
    send(end(0), numbered(0x100, 8));
    if (k % 50 == 49) rig_->wait();
  }
  rig_->wait();
  // The loss is told with the first frame behind it.
  std::uint64_t fetched = 0;
  while (end(1).receive()) ++fetched;
  send(end(0), numbered(0x101, 8));
  EXPECT_EQ(next(end(1))->frame.identifier, 0x101U);
  EXPECT_TRUE(event(end(1), BusEventKind::kLost).has_value());
  EXPECT_GT(fetched, 0U);
  EXPECT_GT(end(1).counters().lost, 0U);
  EXPECT_EQ(end(1).counters().lost + end(1).counters().received, static_cast<std::uint64_t>(frames) + 1);
}

TEST_P(FrameBusConformance, TellsWhenItGoesOffAndWhenItIsRestarted) {
  rig_->drive_off();
  EXPECT_TRUE(event(end(0), BusEventKind::kOff).has_value());
  EXPECT_EQ(end(0).state(), BusState::kOff);
  rig_->restart();
  EXPECT_TRUE(event(end(0), BusEventKind::kRestarted).has_value());
  EXPECT_EQ(end(0).state(), BusState::kActive);
  send(end(0), numbered(0x321, 3));
  EXPECT_EQ(next(end(1))->frame.identifier, 0x321U);
}

}  // namespace ironbird::hil_bridge::transport
