#include "hil_bridge/rosflight/stream_decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "hil_bridge/rosflight/test/frame_text.hpp"

namespace ironbird::hil_bridge::rosflight {
namespace {

using test::bytes;
using test::decode;
using test::kCompanion;
using test::kFirmware;

using Bytes = std::vector<std::uint8_t>;

/// A frame of the link's daily traffic, another one for every number.
Bytes traffic(std::uint32_t number) {
  const auto sequence = static_cast<std::uint8_t>(number);
  const auto real = static_cast<float>(number);
  switch (number % 5U) {
    case 0:
      return bytes(
          encode_frame(SmallImu{number, real, -real, -9.8F, 0.1F, 0.2F, 0.3F, 300.0F}, sequence, kFirmware));
    case 1:
      return bytes(encode_frame(AttitudeQuaternion{.time_boot_ms = number, .q1 = 1.0F}, sequence, kFirmware));
    case 2:
      return bytes(encode_frame(RosflightCmdAck{6, 1}, sequence, kFirmware));
    case 3:
      return bytes(encode_frame(OffboardControl{.u = {0, 0, -real}}, sequence, kCompanion));
    default:
      return bytes(encode_frame(RosflightAuxCmd{.aux_cmd_array = {real}}, sequence, kCompanion));
  }
}

void append(Bytes& stream, const Bytes& more) {
  stream.insert(stream.end(), more.begin(), more.end());
}

bool holds(const std::vector<Frame>& frames, std::uint8_t sequence) {
  return std::any_of(frames.begin(), frames.end(),
                     [&](const Frame& frame) { return frame.sequence == sequence; });
}

TEST(StreamDecoderTest, GivesTheSameFramesHoweverTheBytesAreCut) {
  Bytes stream;
  for (std::uint32_t k = 0; k < 200; ++k) append(stream, traffic(k));
  for (const std::size_t piece : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{78},
                                  std::size_t{4096}, std::size_t{9000}}) {
    StreamDecoder decoder;
    std::vector<Frame> frames;
    for (std::size_t k = 0; k < stream.size(); k += piece) {
      decoder.push(std::span(stream).subspan(k, std::min(piece, stream.size() - k)),
                   [&](const Frame& frame) { frames.push_back(frame); });
    }
    ASSERT_EQ(frames.size(), 200U) << "pieces of " << piece;
    for (std::uint32_t k = 0; k < 200; ++k) EXPECT_EQ(frames[k].sequence, static_cast<std::uint8_t>(k));
    EXPECT_EQ(decoder.counts().bytes, stream.size());
    EXPECT_EQ(decoder.counts().frames, 200U);
    EXPECT_EQ(decoder.counts().skipped_bytes, 0U);
  }
}

TEST(StreamDecoderTest, LosesOnlyTheFrameOfWhichAnyByteIsFalse) {
  for (std::uint32_t kind = 0; kind < 5; ++kind) {
    const Bytes broken = traffic(kind);
    for (std::size_t place = 0; place < broken.size(); ++place) {
      for (const std::uint8_t flip : {0x01, 0x10, 0x80, 0xFF}) {
        Bytes stream = traffic(100);
        append(stream, broken);
        stream[traffic(100).size() + place] ^= flip;
        append(stream, traffic(101));
        append(stream, traffic(102));
        append(stream, Bytes(300, 0));  // time goes on
        StreamDecoder decoder;
        const std::vector<Frame> frames = decode(decoder, stream);
        ASSERT_EQ(frames.size(), 3U) << "kind " << kind << ", byte " << place << " ^ " << int{flip};
        EXPECT_TRUE(holds(frames, 100) && holds(frames, 101) && holds(frames, 102));
      }
    }
  }
}

TEST(StreamDecoderTest, LosesOnlyTheFrameThatLostBytes) {
  for (std::uint32_t kind = 0; kind < 5; ++kind) {
    const Bytes whole = traffic(kind);
    for (std::size_t from = 0; from < whole.size(); ++from) {
      for (std::size_t count = 1; from + count <= whole.size(); ++count) {
        Bytes cut = whole;
        cut.erase(cut.begin() + static_cast<std::ptrdiff_t>(from),
                  cut.begin() + static_cast<std::ptrdiff_t>(from + count));
        Bytes stream = cut;
        append(stream, traffic(101));
        append(stream, traffic(102));
        append(stream, Bytes(300, 0));
        StreamDecoder decoder;
        const std::vector<Frame> frames = decode(decoder, stream);
        ASSERT_TRUE(holds(frames, 101) && holds(frames, 102))
            << "kind " << kind << ", without " << from << "+" << count;
      }
    }
  }
}

TEST(StreamDecoderTest, FindsEveryWholeFrameAmongInsertedBytes) {
  std::mt19937 random(3);
  for (int run = 0; run < 2000; ++run) {
    Bytes stream;
    std::size_t sent = 0;
    for (std::uint32_t k = 0; k < 20; ++k) {
      const std::uint32_t noise = random() % 4U == 0U ? random() % 30U : 0U;
      for (std::uint32_t n = 0; n < noise; ++n) {
        stream.push_back(random() % 3U == 0U ? kFrameStart : static_cast<std::uint8_t>(random()));
      }
      append(stream, traffic(k));
      ++sent;
    }
    append(stream, Bytes(300, 0));
    StreamDecoder decoder;
    EXPECT_GE(decode(decoder, stream).size(), sent) << "run " << run;
  }
}

TEST(StreamDecoderTest, RefusesASoundFrameOfAnotherDialect) {
  // GIVEN the command of the beta firmware: 26 bytes, its own check byte
  Bytes frame = {kFrameStart, 26, 0, 1, 50, 180};
  frame.resize(32);
  std::uint16_t crc = kCrcStart;
  for (std::size_t k = 1; k < frame.size(); ++k) crc = crc_of(crc, frame[k]);
  crc = crc_of(crc, 190);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  StreamDecoder decoder;
  EXPECT_TRUE(decode(decoder, frame).empty());
  EXPECT_EQ(decoder.counts().foreign, 1U);
  EXPECT_EQ(decoder.counts().skipped_bytes, frame.size());
}

TEST(StreamDecoderTest, DoesNotJoinTwoHalvesAcrossACutLine) {
  const Bytes frame = traffic(0);
  const auto half = static_cast<std::ptrdiff_t>(frame.size() / 2);
  StreamDecoder decoder;
  EXPECT_TRUE(decode(decoder, Bytes(frame.begin(), frame.begin() + half)).empty());
  decoder.clear();
  EXPECT_TRUE(decode(decoder, Bytes(frame.begin() + half, frame.end())).empty());
  EXPECT_EQ(decode(decoder, traffic(1)).size(), 1U);
}

/// Headers of the longest message, three bytes apart: each claims 78 bytes, so that all bytes are gone over
/// as often as can be.
Bytes densest_headers(std::size_t size) {
  constexpr std::uint8_t kPattern[3] = {kFrameStart, 70, 193};
  Bytes stream(size);
  for (std::size_t k = 0; k < size; ++k) stream[k] = kPattern[k % 3];
  return stream;
}

TEST(StreamDecoderTest, GoesOverHostileBytesNoOftenerThanItSays) {
  StreamDecoder decoder;
  EXPECT_TRUE(decode(decoder, densest_headers(30'000)).empty());
  EXPECT_NEAR(static_cast<double>(decoder.counts().corrupted), 10'000.0, 30.0);
  EXPECT_EQ(decode(decoder, traffic(3)).size(), 0U) << "the last header still waits for its 78 bytes";
  const Bytes later(100, 0);
  EXPECT_EQ(decode(decoder, later).size(), 1U);
}

TEST(StreamDecoderTest, SurvivesAnyStreamOfBytes) {
  std::mt19937 random(7);
  StreamDecoder decoder;
  std::size_t found = 0;
  Bytes stream(1000);
  for (int run = 0; run < 3000; ++run) {
    for (std::uint8_t& byte : stream) {
      const std::uint32_t any = random();
      constexpr std::uint8_t kUsual[4] = {kFrameStart, 36, 181, 250};
      byte = any % 4U == 0U ? kUsual[(any >> 2U) % 4U] : static_cast<std::uint8_t>(any >> 8U);
    }
    found += decode(decoder, stream).size();
  }
  EXPECT_GT(decoder.counts().corrupted, 500U);
  EXPECT_EQ(found, 0U) << "one in 65536 checksums is right by chance";
}

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
