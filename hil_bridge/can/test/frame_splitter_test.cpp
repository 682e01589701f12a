#include <gtest/gtest.h>

#include "hil_bridge/can/dronecan_transfer.hpp"
#include "hil_bridge/can/test/transfer_file.hpp"

namespace ironbird::hil_bridge::can {
namespace {

/// The free choice of whoever recorded the anonymous transfers.
constexpr std::uint16_t kRecordedDiscriminator = 0x1234;

std::vector<CanFrame> frames_of(const TransferHead& head, std::uint16_t seed,
                                std::span<const std::uint8_t> payload, bool fd = false) {
  FrameSplitter splitter(head, seed, payload, fd, kRecordedDiscriminator);
  std::vector<CanFrame> frames;
  const std::size_t count = splitter.count();
  while (const std::optional<CanFrame> frame = splitter.next()) frames.push_back(*frame);
  EXPECT_EQ(frames.size(), count);
  return frames;
}

std::vector<std::string> texts_of(const std::vector<CanFrame>& frames) {
  std::vector<std::string> texts;
  for (const CanFrame& frame : frames) texts.push_back(text_of(frame));
  return texts;
}

TEST(FrameSplitterTest, MakesTheFramesOfEveryRecordedTransfer) {
  for (const RecordedTransfer& transfer : recorded_transfers()) {
    EXPECT_EQ(texts_of(frames_of(transfer.head, crc_seed(transfer.signature), transfer.payload)),
              texts_of(transfer.frames))
        << transfer.type << ' ' << transfer.values;
  }
}

TEST(FrameSplitterTest, ReadsTheHeadOfEveryRecordedFrame) {
  for (const RecordedTransfer& transfer : recorded_transfers()) {
    for (const CanFrame& frame : transfer.frames) {
      std::optional<TransferHead> head = head_of(frame.identifier);
      ASSERT_TRUE(head.has_value());
      head->transfer_id = transfer.head.transfer_id;
      EXPECT_EQ(*head, transfer.head) << transfer.type;
    }
  }
}

TEST(FrameSplitterTest, ChecksTheDigitsAsEveryCrc16CcittFalse) {
  std::uint16_t crc = kCrcStart;
  for (const char digit : std::string_view("123456789")) crc = crc_of(crc, static_cast<std::uint8_t>(digit));
  EXPECT_EQ(crc, 0x29B1);
}

constexpr TransferHead kCommand = {8, TransferKind::kMessage, 1030, 10, 0, 7};
constexpr std::uint16_t kCommandSeed = 0xE4B8;

TEST(FrameSplitterTest, FillsAFrameOfCanFdWithZerosBeforeTheTail) {
  const std::vector<std::uint8_t> payload = bytes_of("27407A03DC174078");
  const std::vector<CanFrame> frames = frames_of(kCommand, kCommandSeed, payload, true);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(text_of(frames[0]), "0804060A##27407A03DC174078000000C7");
}

TEST(FrameSplitterTest, GivesAnEmptyPayloadOneFrameOfATail) {
  const std::vector<CanFrame> frames = frames_of(kCommand, kCommandSeed, {});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(text_of(frames[0]), "0804060A#C7");
}

TEST(FrameSplitterTest, MakesOnlyFramesThatABusCanCarry) {
  for (const bool fd : {false, true}) {
    for (std::size_t size = 0; size <= 400; ++size) {
      const std::vector<std::uint8_t> payload(size, 0xA5);
      for (const CanFrame& frame : frames_of(kCommand, kCommandSeed, payload, fd)) {
        ASSERT_TRUE(is_sendable(frame)) << size;
        ASSERT_EQ(frame.fd, fd);
      }
    }
  }
}

TEST(FrameSplitterTest, TogglesFromZeroAndMarksBothEnds) {
  const std::vector<std::uint8_t> payload(4 * 7 - 2);
  const std::vector<CanFrame> frames = frames_of(kCommand, kCommandSeed, payload);
  constexpr std::array<std::uint8_t, 4> kTails = {0x80 | 7, 0x20 | 7, 0x00 | 7, 0x60 | 7};
  ASSERT_EQ(frames.size(), kTails.size());
  for (std::size_t k = 0; k < kTails.size(); ++k) EXPECT_EQ(frames[k].data[frames[k].size - 1U], kTails[k]);
}

TEST(TransferIdsTest, CountForEachTypeKindAndDestinationFromZeroAndWrapAt32) {
  constexpr TypeKey kMessage = {1, TransferKind::kMessage};
  constexpr TypeKey kRequest = {1, TransferKind::kRequest};
  TransferIds ids(std::array{kMessage, kRequest});
  for (int k = 0; k < 70; ++k) EXPECT_EQ(ids.next(kMessage, 0), k % 32);
  EXPECT_EQ(ids.next(kRequest, 20), 0);
  EXPECT_EQ(ids.next(kRequest, 21), 0);
  EXPECT_EQ(ids.next(kRequest, 20), 1);
  EXPECT_EQ(ids.next(kMessage, 0), 70 % 32);
}

TEST(CanFrameTest, KnowsTheLengthsOfCanFd) {
  CanFrame frame;
  frame.fd = true;
  std::vector<int> lengths;
  for (int size = 0; size <= 64; ++size) {
    frame.size = static_cast<std::uint8_t>(size);
    if (is_sendable(frame)) lengths.push_back(size);
  }
  EXPECT_EQ(lengths, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64}));
}

TEST(CanFrameTest, RefusesWhatNoBusCarries) {
  EXPECT_FALSE(is_sendable({.identifier = 0x20000000}));
  EXPECT_FALSE(is_sendable({.identifier = 0x800, .extended = false}));
  EXPECT_FALSE(is_sendable({.size = 9}));
  EXPECT_FALSE(is_sendable({.bit_rate_switch = true}));
  EXPECT_FALSE(is_sendable({.remote = true, .fd = true}));
  EXPECT_FALSE(is_sendable({.error = true}));
  EXPECT_TRUE(is_sendable({.identifier = 0x7FF, .extended = false, .size = 8}));
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
