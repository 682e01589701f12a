#include <gtest/gtest.h>

#include <cmath>

#include "hil_bridge/can/dronecan_messages.hpp"
#include "hil_bridge/can/test/other_messages.hpp"
#include "hil_bridge/can/test/transfer_file.hpp"

namespace ironbird::hil_bridge::can {
namespace {

/// Compares two messages member by member, as they are described.
template <class M>
bool same(const M& a, const M& b) {
  const Payload<M> one = encode(a);
  const Payload<M> other = encode(b);
  return std::equal(one.view().begin(), one.view().end(), other.view().begin(), other.view().end());
}

template <class M>
void expect_recorded(std::size_t place, const M& message) {
  const RecordedTransfer& recorded = recorded_transfers()[place];
  SCOPED_TRACE(recorded.type + ' ' + recorded.values);
  EXPECT_EQ(M::kType.name, recorded.type);
  EXPECT_EQ(M::kType.key, (TypeKey{recorded.head.data_type_id, recorded.head.kind}));
  EXPECT_EQ(M::kType.signature, recorded.signature);
  const Payload<M> payload = encode(message);
  EXPECT_EQ(std::vector(payload.view().begin(), payload.view().end()), recorded.payload);
  const std::optional<M> back = decode<M>(recorded.payload);
  ASSERT_TRUE(back.has_value());
  EXPECT_TRUE(same(*back, message));
}

template <class T, std::size_t N>
BoundedList<T, N> list(std::initializer_list<int> items) {
  BoundedList<T, N> all;
  for (const int item : items) all.push(static_cast<T>(item));
  return all;
}

TEST(MessagesTest, LieOnTheWireAsRecordedNodesAndMotors) {
  expect_recorded(0, NodeStatus{1234, 1, 0, 0, 0xBEEF});
  expect_recorded(1, NodeStatus{0x01020304, 2, 3, 5, 0x8001});
  expect_recorded(2, RawCommand{list<std::int16_t, 20>({1000, 2000, 3000, 4000})});
  expect_recorded(3, RawCommand{list<std::int16_t, 20>({8191, -1, 0, -8192})});
  expect_recorded(4, RawCommand{list<std::int16_t, 20>({1000, 2000, 3000, 4000, 5000, -6000})});
  expect_recorded(5, RawCommand{list<std::int16_t, 20>({8191})});
  expect_recorded(6, RpmCommand{list<std::int32_t, 20>({10000, -2000})});
  expect_recorded(7, EscStatus{3, 15.5F, -2.25F, 313.0F, -12345, 42, 2});
  expect_recorded(8, EscStatusExtended{50, 48, -5, 359, 0x12345, 2});
  expect_recorded(12, ArmingStatus{ArmingStatus::kArmed});
}

HardwareVersion recorded_hardware() {
  HardwareVersion hardware = {.major = 3, .minor = 4};
  for (std::size_t k = 0; k < 16; ++k) hardware.unique_id[k] = static_cast<std::uint8_t>(0xA0 + k);
  return hardware;
}

TEST(MessagesTest, LieOnTheWireAsRecordedServices) {
  expect_recorded(13, GetNodeInfoRequest{});
  expect_recorded(14, GetNodeInfoResponse{{.uptime_sec = 60},
                                          {1, 2, 1, 0xCAFEF00D, 0},
                                          recorded_hardware(),
                                          BoundedText<80>("org.example.esc")});
  expect_recorded(15, GetSetRequest{.index = 5});
  expect_recorded(16, GetSetRequest{0, std::int64_t{3}, ParameterName("ESC_INDEX")});
  expect_recorded(17, GetSetResponse{std::int64_t{3}, std::int64_t{0}, std::int64_t{31}, std::int64_t{0},
                                     ParameterName("ESC_INDEX")});
  expect_recorded(23, RestartNodeRequest{RestartNodeRequest::kMagicNumber});
}

TEST(MessagesTest, LieOnTheWireAsRecordedAllocation) {
  const auto part = [](int from, int to) {
    BoundedList<std::uint8_t, 16> bytes;
    for (int k = from; k <= to; ++k) bytes.push(static_cast<std::uint8_t>(0xA0 + k));
    return bytes;
  };
  expect_recorded(18, Allocation{0, true, part(0, 5)});
  expect_recorded(19, Allocation{0, false, part(0, 5)});
  expect_recorded(20, Allocation{0, false, part(6, 11)});
  expect_recorded(21, Allocation{0, false, part(12, 15)});
  expect_recorded(22, Allocation{125, false, part(0, 15)});
}

TEST(MessagesTest, CanBeDescribedThatThisRoomDoesNotKnow) {
  expect_recorded(11, ActuatorStatus{3, 0.25F, 1.5F, -2.0F, 127});
  expect_recorded(24, LogMessage{2, BoundedText<31>("esc"), BoundedText<90>("hot")});
  expect_recorded(25, BatteryInfo{.temperature = 300.0F, .voltage = 22.2F, .current = 10.0F});
}

struct Width {
  std::string_view name;
  std::uint16_t seed;
  std::size_t bits;
};
template <class M>
Width width() {
  return {M::kType.name, crc_seed(M::kType.signature), kGreatestBits<M>};
}

TEST(MessagesTest, HaveTheSeedsAndTheLengthsOfTheirDefinitions) {
  const std::vector<std::pair<Width, Width>> table = {{width<NodeStatus>(), {"", 0xBE5F, 56}},
                                                      {width<GetNodeInfoRequest>(), {"", 0xD9A7, 0}},
                                                      {width<GetNodeInfoResponse>(), {"", 0xD9A7, 3015}},
                                                      {width<GetSetRequest>(), {"", 0xFB10, 1791}},
                                                      {width<GetSetResponse>(), {"", 0xFB10, 2967}},
                                                      {width<ExecuteOpcodeRequest>(), {"", 0xD7D4, 56}},
                                                      {width<ExecuteOpcodeResponse>(), {"", 0xD7D4, 49}},
                                                      {width<RestartNodeRequest>(), {"", 0x1F7F, 40}},
                                                      {width<RestartNodeResponse>(), {"", 0x1F7F, 1}},
                                                      {width<Allocation>(), {"", 0xF258, 141}},
                                                      {width<RawCommand>(), {"", 0xE4B8, 5 + 14 * 20}},
                                                      {width<RpmCommand>(), {"", 0xF8B4, 5 + 18 * 20}},
                                                      {width<EscStatus>(), {"", 0x1591, 110}},
                                                      {width<EscStatusExtended>(), {"", 0xE786, 56}},
                                                      {width<ArmingStatus>(), {"", 0x1890, 8}}};
  for (const auto& [computed, expected] : table) {
    EXPECT_EQ(computed.seed, expected.seed) << computed.name;
    EXPECT_EQ(computed.bits, expected.bits) << computed.name;
  }
}

TEST(MessagesTest, SayTheLengthOfTheirLastArrayInCanFdAlone) {
  const RawCommand command = {list<std::int16_t, 20>({1000, 2000, 3000, 4000})};
  const Payload<RawCommand> payload = encode(command, true);
  EXPECT_EQ(std::vector(payload.view().begin(), payload.view().end()), bytes_of("27407A03DC174078"));
  const std::vector<std::uint8_t> padded = bytes_of("27407A03DC174078000000");
  ASSERT_TRUE(decode<RawCommand>(padded, true).has_value());
  EXPECT_EQ(decode<RawCommand>(padded, true)->cmd, command.cmd);
}

TEST(MessagesTest, ClipWhatDoesNotFit) {
  EXPECT_EQ(decode<RawCommand>(encode(RawCommand{list<std::int16_t, 20>({20000, -20000})}).view())->cmd,
            (list<std::int16_t, 20>({8191, -8192})));
  const auto status =
      decode<EscStatus>(encode(EscStatus{.voltage = 1e9F, .rpm = 1 << 20, .power_rating_pct = 200}).view());
  EXPECT_EQ(status->voltage, 65504.0F);
  EXPECT_EQ(status->rpm, 131071);
  EXPECT_EQ(status->power_rating_pct, 127);
}

TEST(MessagesTest, CarryWhatAnEscDoesNotKnow) {
  const auto status = decode<EscStatus>(encode(EscStatus{.voltage = NAN, .current = INFINITY}).view());
  EXPECT_TRUE(std::isnan(status->voltage));
  EXPECT_TRUE(std::isinf(status->current));
}

TEST(MessagesTest, CarryEveryKindOfParameterValue) {
  const std::array<ParameterValue, 5> values = {std::monostate{}, std::int64_t{-7'000'000'000}, -1.25F,
                                                std::uint8_t{1}, BoundedText<128>("a text")};
  for (const ParameterValue& value : values) {
    const GetSetResponse sent = {value, value, std::int64_t{-1}, 2.5F, ParameterName("NAME")};
    for (const bool fd : {false, true}) {
      const std::optional<GetSetResponse> back = decode<GetSetResponse>(encode(sent, fd).view(), fd);
      ASSERT_TRUE(back.has_value());
      EXPECT_EQ(back->value, value);
      EXPECT_EQ(back->default_value, value);
      EXPECT_EQ(back->min_value, ParameterBound(2.5F));
      EXPECT_EQ(back->name.text(), "NAME");
    }
  }
}

TEST(MessagesTest, AreRefusedWhenTooShortOrTooLong) {
  const std::vector<std::uint8_t> whole = bytes_of("03000000c04b80c0e45cc7cfd508");
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    EXPECT_EQ(decode<EscStatus>(std::span(whole).first(size)).has_value(), size == whole.size()) << size;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(decode<EscStatus>(longer).has_value());
  EXPECT_TRUE(decode<EscStatus>(longer, true).has_value()) << "padding of CAN FD";
  longer.back() = 1;
  EXPECT_FALSE(decode<EscStatus>(longer, true).has_value()) << "padding is zeros";
}

TEST(MessagesTest, AreRefusedWhenTheirBitsMakeNoSense) {
  EXPECT_FALSE(decode<RawCommand>(bytes_of("E80F40")).has_value()) << "one command and a half";
  EXPECT_FALSE(decode<RawCommand>(std::vector<std::uint8_t>(37)).has_value()) << "21 commands";
  EXPECT_FALSE(decode<GetSetRequest>(bytes_of("0505")).has_value()) << "a sixth kind of value";
  EXPECT_FALSE(decode<RawCommand>(bytes_of("F8"), true).has_value()) << "31 commands";
}

TEST(MessagesTest, CutTextThatIsTooLong) {
  EXPECT_EQ(BoundedText<4>("abcdef").text(), "abcd");
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
