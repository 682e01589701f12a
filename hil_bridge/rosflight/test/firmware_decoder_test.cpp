#include "hil_bridge/rosflight/firmware_decoder.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "hil_bridge/rosflight/dialect.hpp"
#include "hil_bridge/rosflight/test/frame_text.hpp"

namespace ironbird::hil_bridge::rosflight {
namespace {

using test::bytes;
using test::decode;
using test::kCompanion;

TEST(FirmwareDecoderTest, FindsFramesBetweenOtherBytes) {
  std::vector<std::uint8_t> stream = {0x00, 0xFD, 0x42};
  for (int k = 0; k < 3; ++k) {
    const auto frame = bytes(encode_frame(RosflightCmd{10}, static_cast<std::uint8_t>(k), kCompanion));
    stream.insert(stream.end(), frame.begin(), frame.end());
    stream.push_back(0x07);
  }
  FirmwareDecoder decoder;
  EXPECT_EQ(decode(decoder, stream).size(), 3U);
}

TEST(FirmwareDecoderTest, LosesOnlyTheFrameWhoseChecksumIsWrong) {
  const auto good = bytes(encode_frame(RosflightCmd{10}, 1, kCompanion));
  for (std::size_t place = 2; place < good.size(); ++place) {
    std::vector<std::uint8_t> stream = good;
    stream[place] ^= 0x10;
    stream.insert(stream.end(), good.begin(), good.end());
    FirmwareDecoder decoder;
    EXPECT_EQ(decode(decoder, stream).size(), 1U) << "bit flipped in byte " << place;
    EXPECT_EQ(decoder.corrupted(), 1);
  }
}

TEST(FirmwareDecoderTest, SwallowsFourFramesBehindALengthThatWasRaisedToForty) {
  const auto good = bytes(encode_frame(RosflightCmd{10}, 1, kCompanion));
  std::vector<std::uint8_t> stream;
  for (int k = 0; k < 7; ++k) stream.insert(stream.end(), good.begin(), good.end());
  stream[1] = 40;  // 48 bytes: itself, four whole frames, and three bytes of the next
  FirmwareDecoder decoder;
  EXPECT_EQ(decode(decoder, stream).size(), 1U);
  EXPECT_EQ(decoder.corrupted(), 1);
}

TEST(FirmwareDecoderTest, TakesAStartByteAtTheEndOfABadFrameForANewStart) {
  const auto good = bytes(encode_frame(RosflightCmd{10}, 1, kCompanion));
  std::vector<std::uint8_t> stream = good;
  stream.back() = 0xFE;
  stream.insert(stream.end(), good.begin() + 1, good.end());
  FirmwareDecoder decoder;
  EXPECT_EQ(decode(decoder, stream).size(), 1U);
}

TEST(FirmwareDecoderTest, PassesOverUnknownNumbersAndFalseLengths) {
  const auto framed = [](std::uint8_t id, std::uint8_t extra, const std::vector<std::uint8_t>& payload) {
    std::vector<std::uint8_t> frame = {0xFE, static_cast<std::uint8_t>(payload.size()), 0, 1, 50, id};
    for (const std::uint8_t byte : payload) frame.push_back(byte);
    std::uint16_t crc = kCrcStart;
    for (std::size_t k = 1; k < frame.size(); ++k) crc = crc_of(crc, frame[k]);
    crc = crc_of(crc, extra);
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
    return frame;
  };
  FirmwareDecoder decoder;
  EXPECT_TRUE(decode(decoder, framed(200, 0, {1, 2, 3})).empty());
  EXPECT_TRUE(decode(decoder, framed(188, 249, {})).empty());
  EXPECT_TRUE(decode(decoder, framed(188, 249, std::vector<std::uint8_t>(201, 10))).empty());
  EXPECT_TRUE(decode(decoder, framed(188, 249, std::vector<std::uint8_t>(255, 10))).empty());
  EXPECT_EQ(decoder.unknown(), 4);
  EXPECT_EQ(decode(decoder, framed(188, 249, {10})).size(), 1U);
}

TEST(FirmwareDecoderTest, SurvivesAnyStreamOfBytes) {
  std::mt19937 random(7);
  FirmwareDecoder decoder;
  int found = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    const std::uint32_t any = random();
    found += decoder.push(any % 16U == 0U ? 0xFE : static_cast<std::uint8_t>(any >> 8U)).has_value() ? 1 : 0;
  }
  EXPECT_GT(decoder.corrupted(), 1000);
  EXPECT_LE(found, 2) << "one in 65536 checksums is right by chance";
}

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
