#include "hil_bridge/rosflight/frame_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/rosflight/dialect.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/rosflight/test/frame_text.hpp"

namespace ironbird::hil_bridge::rosflight {
namespace {

using test::bytes;
using test::decode;
using test::hex;
using test::kCompanion;
using test::kFirmware;

/// A frame that the project's own generated code gave for these contents.
struct Worked {
  const char* name;
  Message message;
  std::uint8_t sequence;
  Address sender;
  const char* hex;
};

const std::vector<Worked>& worked_frames() {
  static const std::vector<Worked> frames = {
      {"heartbeat", Heartbeat{.mavlink_version = 2}, 0, kCompanion, "fe090001320000000000000000000275c2"},
      {"version request", RosflightCmd{.command = 10}, 1, kCompanion, "fe01010132bc0a6e2e"},
      {"parameter list", ParamRequestList{.target_system = 1, .target_component = 0}, 2, kCompanion,
       "fe020201321501007e1d"},
      {"integer set",
       ParamSet{.param_value = {6},
                .target_system = 1,
                .target_component = 0,
                .param_id = field_of<16>("NUM_MOTORS"),
                .param_type = 6},
       3, kCompanion, "fe17030132170600000001004e554d5f4d4f544f5253000000000000069a5c"},
      {"real set",
       ParamSet{.param_value = {std::bit_cast<std::uint32_t>(0.9F)},
                .target_system = 1,
                .target_component = 0,
                .param_id = field_of<16>("RC_MAX_THR"),
                .param_type = 9},
       4, kCompanion, "fe17040132176666663f010052435f4d41585f5448520000000000000949b6"},
      {"pass-through", OffboardControl{.u = {0, 0, -34.335F, 0.1F, -0.2F, 0.05F}, .ignore = 0, .mode = 0}, 5,
       kCompanion,
       "fe2b050132b400000000000000000a5709c2cdcccc3dcdcc4cbecdcc4c3d00000000000000000000000000000000000000aa0"
       "e"},
      {"time request", Timesync{.tc1 = 0, .ts1 = 1234567890123456789}, 6, kCompanion,
       "fe100601326f00000000000000001581e97df41022119e11"},
      {"inertial sample", SmallImu{2'500'000, 0.1F, -0.2F, -9.80665F, 0.01F, 0.02F, -0.03F, 300.15F}, 7,
       kFirmware, "fe240701fab5a025260000000000cdcccc3dcdcc4cbe0ae81cc10ad7233c0ad7a33c8fc2f5bc331396439314"},
      {"status", RosflightStatus{.rc_override = 0x020, .loop_time_us = 85, .armed = 1, .offboard = 1}, 8,
       kFirmware, "fe0b0801fabf20000000550001000100005777"},
      {"parameter",
       ParamValue{{4}, 333, 2, field_of<16>("NUM_MOTORS"), 6},
       9,
       {1, 0},
       "fe1909010016040000004d0102004e554d5f4d4f544f525300000000000006b81a"},
      {"fix",
       RosflightGnss{1767225600, 40.2463724, -111.6474138, 2'500'000, 250'000'000, 1387.0F, 1.5F, -0.25F,
                     0.125F, 0.21F, 0.4F, 0.01F, 3, 15},
       10, kFirmware,
       "fe420a01fac500b95569000000008a517c21891f4440a97e4a3a6fe95bc0a02526000000000080b2e60e0060ad440000c03f"
       "000080be0000003e3d0a573ecdcccc3e0ad7233c030f4559"},
      {"auxiliary", RosflightAuxCmd{.aux_cmd_array = {0, 0, 0, 0, 0.5F}, .type_array = {0, 0, 0, 0, 1}}, 11,
       kCompanion,
       "fe460b0132c1000000000000000000000000000000000000003f000000000000000000000000000000000000000000000000"
       "00000000000000000000000000000000010000000000000000005943"},
      {"acknowledgement", RosflightCmdAck{.command = 6, .success = 1}, 12, kFirmware, "fe020c01fabd06014056"},
      {"external attitude", ExternalAttitude{.qw = 1.0F}, 13, kCompanion,
       "fe100d0132c30000803f000000000000000000000000ac0b"}};
  return frames;
}

TEST(FrameCodecTest, EncodesEveryWorkedFrame) {
  EXPECT_EQ(worked_frames().size(), 14U);
  for (const Worked& worked : worked_frames()) {
    EXPECT_EQ(hex(encode_frame(worked.message, worked.sequence, worked.sender)), worked.hex) << worked.name;
  }
}

TEST(FrameCodecTest, DecodesEveryWorkedFrame) {
  StreamDecoder decoder;
  for (const Worked& worked : worked_frames()) {
    std::vector<std::uint8_t> stream;
    const std::string_view text = worked.hex;
    for (std::size_t k = 0; k < text.size(); k += 2) {
      stream.push_back(static_cast<std::uint8_t>(std::stoi(std::string(text.substr(k, 2)), nullptr, 16)));
    }
    const std::vector<Frame> frames = decode(decoder, stream);
    ASSERT_EQ(frames.size(), 1U) << worked.name;
    EXPECT_EQ(frames[0].sequence, worked.sequence);
    EXPECT_EQ(frames[0].sender.system, worked.sender.system);
    EXPECT_EQ(frames[0].sender.component, worked.sender.component);
    ASSERT_EQ(frames[0].message.index(), worked.message.index()) << worked.name;
    // Two messages whose bytes agree are the same: every field has its own bytes.
    EXPECT_EQ(hex(encode_frame(frames[0].message, worked.sequence, worked.sender)), worked.hex);
  }
  EXPECT_EQ(decoder.counts().skipped_bytes, 0U);
}

TEST(FrameCodecTest, ReadsTheFieldsOfAFix) {
  StreamDecoder decoder;
  const Worked& worked = worked_frames()[10];
  const auto frames = decode(decoder, bytes(encode_frame(worked.message, 10, kFirmware)));
  const auto& fix = std::get<RosflightGnss>(frames.at(0).message);
  EXPECT_EQ(fix.seconds, 1767225600);
  EXPECT_EQ(fix.lat, 40.2463724);
  EXPECT_EQ(fix.lon, -111.6474138);
  EXPECT_EQ(fix.nanos, 250'000'000);
  EXPECT_EQ(fix.vel_n, 1.5F);
  EXPECT_EQ(fix.s_acc, 0.01F);
  EXPECT_EQ(fix.num_sat, 15);
}

/// The bits of a NaN with a payload of its own, which arithmetic would lose.
constexpr std::uint32_t kOddNan = 0xFFA12345;

TEST(FrameCodecTest, CarriesAnIntegerWhoseBitsAreANan) {
  StreamDecoder decoder;
  for (const std::uint32_t value : {0xFFFFFFFFU, kOddNan}) {
    const auto frames = decode(decoder, bytes(encode_frame(ParamSet{.param_value = {value}}, 0, kCompanion)));
    EXPECT_EQ(std::get<ParamSet>(frames.at(0).message).param_value.bits, value);
  }
}

template <class... M>
std::vector<Message> one_of_each(std::type_identity<std::variant<M...>>) {
  return {M{}...};
}

TEST(FrameCodecTest, GivesEveryMessageBackByteForByte) {
  std::mt19937 random(25);
  StreamDecoder decoder;
  for (const Message& message : one_of_each(std::type_identity<Message>{})) {
    const MessageInfo& info = kDialect[message.index()];
    for (int run = 0; run < 100; ++run) {
      // GIVEN a frame of this kind with any bytes in its payload, under a good checksum
      FrameBytes frame = encode_frame(message, static_cast<std::uint8_t>(run), kFirmware);
      std::uint16_t crc = kCrcStart;
      for (std::size_t k = 6; k < 6U + info.length; ++k) frame.bytes[k] = static_cast<std::uint8_t>(random());
      for (std::size_t k = 1; k < 6U + info.length; ++k) crc = crc_of(crc, frame.bytes[k]);
      crc = crc_of(crc, info.crc_extra);
      frame.bytes[6U + info.length] = static_cast<std::uint8_t>(crc & 0xFFU);
      frame.bytes[7U + info.length] = static_cast<std::uint8_t>(crc >> 8U);
      // THEN what is decoded from it encodes to the same bytes
      const auto frames = decode(decoder, bytes(frame));
      ASSERT_EQ(frames.size(), 1U) << info.name;
      EXPECT_EQ(hex(encode_frame(frames[0].message, static_cast<std::uint8_t>(run), kFirmware)), hex(frame));
    }
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge::rosflight
