#include <gtest/gtest.h>

#include <numeric>

#include "hil_bridge/can/dronecan_transfer.hpp"
#include "hil_bridge/can/test/transfer_file.hpp"

namespace ironbird::hil_bridge::can {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint16_t kSeed = 0x1591;
constexpr TypeKey kStatus = {1034, TransferKind::kMessage};
constexpr std::uint8_t kOwnNode = 10;
constexpr std::uint16_t kCapacity = 400;

/// One sender's transfers towards one receiver. Payloads tell which transfer it was by their first byte.
class TransferReceiverTest : public ::testing::Test {
 protected:
  static std::vector<CanFrame> frames(std::uint8_t id, std::uint8_t mark, std::size_t size = 14,
                                      std::uint8_t source = 20, bool fd = false) {
    std::vector<std::uint8_t> payload(size);
    std::iota(payload.begin(), payload.end(), mark);
    FrameSplitter splitter({16, kStatus.kind, kStatus.data_type_id, source, 0, id}, kSeed, payload, fd);
    std::vector<CanFrame> all;
    while (const auto frame = splitter.next()) all.push_back(*frame);
    return all;
  }

  /// @return the mark of the transfer that the frames complete, -1 when there is none
  int push(const std::vector<CanFrame>& frames, Time stamp) {
    int mark = -1;
    for (const CanFrame& frame : frames) {
      if (const auto transfer = receiver_.push(frame, stamp)) mark = transfer->payload[0];
    }
    return mark;
  }
  int push(const CanFrame& frame, Time stamp) { return push(std::vector{frame}, stamp); }
  const TransferCounters& counters() const { return receiver_.counters(); }

  TransferReceiver receiver_{kOwnNode, std::array{Subscription{kStatus, kSeed, kCapacity}}};
};

TEST_F(TransferReceiverTest, PutsEveryRecordedTransferTogether) {
  for (const RecordedTransfer& recorded : recorded_transfers()) {
    const Subscription subscription = {
        {recorded.head.data_type_id, recorded.head.kind}, crc_seed(recorded.signature), kCapacity};
    const std::uint8_t node = recorded.head.destination != 0 ? recorded.head.destination : kOwnNode;
    TransferReceiver receiver(node, std::array{subscription});
    for (std::size_t k = 0; k < recorded.frames.size(); ++k) {
      const auto transfer = receiver.push(recorded.frames[k], seconds(1));
      ASSERT_EQ(transfer.has_value(), k + 1 == recorded.frames.size()) << recorded.type;
      if (!transfer) continue;
      EXPECT_EQ(transfer->head, recorded.head);
      EXPECT_EQ(std::vector(transfer->payload.begin(), transfer->payload.end()), recorded.payload);
    }
  }
}

TEST_F(TransferReceiverTest, TakesTransfersOfEveryLengthInBothFormats) {
  std::uint8_t id = 0;
  for (const bool fd : {false, true}) {
    for (std::size_t size = 1; size <= kCapacity; ++size) {
      ASSERT_EQ(push(frames(id, 77, size, 20, fd), seconds(1)), 77) << size;
      id = (id + 1U) % 32U;
    }
  }
}

TEST_F(TransferReceiverTest, TakesAnyIdOfASenderNotHeardBefore) {
  EXPECT_EQ(push(frames(17, 1), seconds(1)), 1);
}

TEST_F(TransferReceiverTest, TakesIdsOneAfterTheOtherAcrossTheWrap) {
  for (int k = 0; k < 70; ++k) EXPECT_EQ(push(frames(k % 32, 5), milliseconds(10 * k)), 5);
}

TEST_F(TransferReceiverTest, IgnoresARepetitionOfTheTransferJustCompleted) {
  for (const std::size_t size : {3U, 14U}) {
    EXPECT_EQ(push(frames(8, 1, size), seconds(1)), 1);
    EXPECT_EQ(push(frames(8, 2, size), seconds(2)), -1);
    EXPECT_EQ(push(frames(9, 3, size), seconds(2)), 3);
  }
}

TEST_F(TransferReceiverTest, TakesTheSameIdAgainMoreThanTwoSecondsAfterTheTransferBegan) {
  EXPECT_EQ(push(frames(8, 1), seconds(1)), 1);
  EXPECT_EQ(push(frames(8, 2), seconds(3)), -1);
  EXPECT_EQ(push(frames(8, 2), seconds(3) + Time(1)), 2);
}

TEST_F(TransferReceiverTest, StartsAnewWithAnyOtherIdThanTheOneJustCompleted) {
  for (int id = 0; id < 32; ++id) {
    TransferReceiver receiver(kOwnNode, std::array{Subscription{kStatus, kSeed, kCapacity}});
    for (const CanFrame& frame : frames(8, 1)) receiver.push(frame, seconds(1));
    std::size_t taken = 0;
    for (const CanFrame& frame : frames(static_cast<std::uint8_t>(id), 2)) {
      taken += receiver.push(frame, seconds(1)).has_value() ? 1 : 0;
    }
    EXPECT_EQ(taken, id == 8 ? 0U : 1U) << id;
  }
}

TEST_F(TransferReceiverTest, StartsAnewWhenATransferWasLeftIncomplete) {
  for (const std::uint8_t next : {7, 8, 9, 20}) {
    const Time stamp = seconds(10 * next);
    push(frames(8, 1)[0], stamp);
    EXPECT_EQ(push(frames(next, 2), stamp), 2) << int{next};
  }
  EXPECT_EQ(counters().abandoned, 4U);
}

TEST_F(TransferReceiverTest, DropsAFrameWithoutItsTransfersStart) {
  const std::vector<CanFrame> whole = frames(8, 1);
  EXPECT_EQ(push({whole[1], whole[2]}, seconds(1)), -1);
  EXPECT_EQ(counters().missed_start, 2U);
  EXPECT_EQ(push(whole, seconds(1)), 1);
}

TEST_F(TransferReceiverTest, DropsAFrameWithTheWrongToggleAndGoesOn) {
  const std::vector<CanFrame> whole = frames(8, 1);
  EXPECT_EQ(push({whole[0], whole[1], whole[1], whole[2]}, seconds(1)), 1);
  EXPECT_EQ(counters().unexpected, 1U);
}

TEST_F(TransferReceiverTest, LosesATransferThatMissesAFrame) {
  const std::vector<CanFrame> whole = frames(8, 1, 40);
  for (std::size_t lost = 0; lost < whole.size(); ++lost) {
    std::vector<CanFrame> rest = frames(static_cast<std::uint8_t>(lost), 1, 40);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(lost));
    EXPECT_EQ(push(rest, seconds(1)), -1) << lost;
  }
}

TEST_F(TransferReceiverTest, DropsAFrameOfAnotherIdInTheMiddleAndGoesOn) {
  const std::vector<CanFrame> whole = frames(8, 1);
  EXPECT_EQ(push({whole[0], frames(9, 2)[1], whole[1], whole[2]}, seconds(1)), 1);
}

TEST_F(TransferReceiverTest, DropsAStartWithTheToggleOfAnotherProtocol) {
  CanFrame foreign = frames(8, 1, 3)[0];
  foreign.data[foreign.size - 1U] |= 0x20U;
  const std::vector<CanFrame> whole = frames(8, 1);
  EXPECT_EQ(push(foreign, seconds(1)), -1);
  EXPECT_EQ(push({whole[0], foreign, whole[1], whole[2]}, seconds(1)), 1);
}

TEST_F(TransferReceiverTest, GivesUpATransferAfterTwoSeconds) {
  const std::vector<CanFrame> whole = frames(8, 1);
  push(whole[0], seconds(1));
  EXPECT_EQ(push({whole[1], whole[2]}, seconds(3) + Time(1)), -1);
  EXPECT_EQ(counters().abandoned, 1U);
  push(whole[0], seconds(5));
  EXPECT_EQ(push({whole[1], whole[2]}, seconds(7)), 1);
}

TEST_F(TransferReceiverTest, DropsATransferWhoseChecksumIsWrong) {
  std::vector<CanFrame> whole = frames(8, 1);
  whole[1].data[2] ^= 0x10U;
  EXPECT_EQ(push(whole, seconds(1)), -1);
  EXPECT_EQ(counters().corrupted, 1U);
  EXPECT_EQ(push(frames(9, 3), seconds(1)), 3);
}

TEST_F(TransferReceiverTest, DropsATransferOfAnotherDefinitionOfTheType) {
  TransferReceiver other(kOwnNode, std::array{Subscription{kStatus, kSeed + 1, kCapacity}});
  for (const CanFrame& frame : frames(8, 1)) EXPECT_FALSE(other.push(frame, seconds(1)));
  EXPECT_EQ(other.counters().corrupted, 1U);
}

TEST_F(TransferReceiverTest, DropsATransferThatIsTooLong) {
  EXPECT_EQ(push(frames(8, 1, kCapacity + 100), seconds(1)), -1);
  EXPECT_EQ(counters().too_long, 1U);
  EXPECT_EQ(push(frames(9, 2, kCapacity), seconds(1)), 2);
}

TEST_F(TransferReceiverTest, DropsAMultipleFrameTransferWithoutRoomForItsChecksum) {
  CanFrame first = frames(8, 1)[0];
  first.data[0] = 0x80 | 8;
  first.size = 1;
  CanFrame last = first;
  last.data[0] = 0x60 | 8;
  EXPECT_EQ(push({first, last}, seconds(1)), -1);
}

TEST_F(TransferReceiverTest, DoesNotMixTheTwoFormats) {
  std::vector<CanFrame> whole = frames(8, 1);
  whole[1].fd = true;
  EXPECT_EQ(push(whole, seconds(1)), -1);
}

TEST_F(TransferReceiverTest, KeepsSendersApart) {
  std::vector<std::vector<CanFrame>> all;
  for (std::uint8_t source = 1; source <= kGreatestNode; ++source)
    all.push_back(frames(8, source, 14, source));
  int whole = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t sender = 0; sender < all.size(); ++sender) {
      whole += push(all[sender][k], seconds(1)) == static_cast<int>(sender) + 1 ? 1 : 0;
    }
  }
  EXPECT_EQ(whole, 127);
}

TEST_F(TransferReceiverTest, KeepsMessagesAndServicesOfTheSameNumberApart) {
  constexpr TypeKey kInfo = {1, TransferKind::kRequest};
  constexpr TypeKey kAllocation = {1, TransferKind::kMessage};
  TransferReceiver receiver(kOwnNode,
                            std::array{Subscription{kInfo, 1, 7}, Subscription{kAllocation, 2, 17}});
  const CanFrame message = frame_of("1E00017F#00A0A1A2A3A4A5C0");
  const CanFrame request = frame_of("18018AFF#C0");
  EXPECT_EQ(receiver.push(message, seconds(1))->head.kind, TransferKind::kMessage);
  EXPECT_EQ(receiver.push(request, seconds(1))->head.kind, TransferKind::kRequest);
}

TEST_F(TransferReceiverTest, IgnoresServicesForOthers) {
  TransferReceiver receiver(kOwnNode, std::array{Subscription{{1, TransferKind::kRequest}, 1, 7}});
  EXPECT_TRUE(receiver.push(frame_of("18018AFF#C0"), seconds(1)));
  EXPECT_FALSE(receiver.push(frame_of("18018BFF#C1"), seconds(1)));
}

TEST_F(TransferReceiverTest, TakesEveryAnonymousTransferByItself) {
  TransferReceiver receiver(kOwnNode, std::array{Subscription{{1, TransferKind::kMessage}, 2, 17}});
  const CanFrame wish = frame_of("1E48D100#01A0A1A2A3A4A5C0");
  EXPECT_TRUE(receiver.push(wish, seconds(1)));
  EXPECT_TRUE(receiver.push(wish, seconds(1)));
  EXPECT_FALSE(receiver.push(frame_of("1E48D100#01A0A1A2A3A4A580"), seconds(1)));
}

TEST_F(TransferReceiverTest, IgnoresFramesThatAreNoneOfDroneCan) {
  CanFrame frame = frames(8, 1, 3)[0];
  frame.extended = false;
  EXPECT_EQ(push(frame, seconds(1)), -1);
  frame.extended = true;
  frame.error = true;
  EXPECT_EQ(push(frame, seconds(1)), -1);
  frame.error = false;
  frame.remote = true;
  EXPECT_EQ(push(frame, seconds(1)), -1);
  frame.remote = false;
  frame.size = 0;
  EXPECT_EQ(push(frame, seconds(1)), -1);
  EXPECT_EQ(counters().not_ours, 4U);
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
