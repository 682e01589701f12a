#include "hil_bridge/rosflight/frame_codec.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <type_traits>
#include <utility>

#include "hil_bridge/rosflight/dialect.hpp"

namespace ironbird::hil_bridge::rosflight {

namespace {

/// Place of each message number in the dialect; beyond its end for those that are not in it.
constexpr auto kPlaces = [] {
  std::array<std::uint8_t, 256> places{};
  places.fill(static_cast<std::uint8_t>(kDialect.size()));
  for (std::size_t k = 0; k < kDialect.size(); ++k) places[kDialect[k].id] = static_cast<std::uint8_t>(k);
  return places;
}();

/// What eight bits do to the checksum.
constexpr auto kCrcTable = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t k = 0; k < table.size(); ++k) table[k] = crc_of(0, static_cast<std::uint8_t>(k));
  return table;
}();

template <std::size_t Size>
using Unsigned =
    std::conditional_t<Size == 1, std::uint8_t,
                       std::conditional_t<Size == 2, std::uint16_t,
                                          std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

/// Writes members one behind the other, low byte first. The members stand in wire order: see dialect.hpp.
class Writer {
 public:
  explicit Writer(std::uint8_t* to) : to_(to) {}

  template <class T>
  void operator()(const char*, const T& member, const char*, const char*) {
    put(member);
  }

 private:
  template <class T, std::size_t N>
  void put(const std::array<T, N>& members) {
    for (const T& member : members) put(member);
  }
  void put(const FloatBits& member) { put(member.bits); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T member) {
    auto bits = std::bit_cast<Unsigned<sizeof(T)>>(member);
    for (std::size_t k = 0; k < sizeof(T); ++k) {
      *to_++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(bits) >> (8U * k));
    }
  }

  std::uint8_t* to_;
};

/// Reads what Writer writes.
class Reader {
 public:
  explicit Reader(const std::uint8_t* from) : from_(from) {}

  template <class T>
  void operator()(const char*, T& member, const char*, const char*) {
    take(member);
  }

 private:
  template <class T, std::size_t N>
  void take(std::array<T, N>& members) {
    for (T& member : members) take(member);
  }
  void take(FloatBits& member) { take(member.bits); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void take(T& member) {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k) bits |= static_cast<std::uint64_t>(*from_++) << (8U * k);
    member = std::bit_cast<T>(static_cast<Unsigned<sizeof(T)>>(bits));
  }

  const std::uint8_t* from_;
};

/// Of everything behind the start byte, and the byte that stands for the dialect.
std::uint16_t checksum(const std::uint8_t* frame, std::size_t length, std::uint8_t extra) {
  std::uint16_t crc = kCrcStart;
  for (std::size_t k = 1; k < kFrameHeader + length; ++k) {
    crc = static_cast<std::uint16_t>((crc >> 8U) ^ kCrcTable[(crc ^ frame[k]) & 0xFFU]);
  }
  return crc_of(crc, extra);
}

template <class M>
Message decoded(const std::uint8_t* payload) {
  M message{};
  M::describe(message, Reader(payload));
  return message;
}

template <std::size_t... Index>
Message decoded_as(std::size_t place, const std::uint8_t* payload, std::index_sequence<Index...>) {
  using Decode = Message (*)(const std::uint8_t*);
  constexpr Decode kDecoders[] = {decoded<std::variant_alternative_t<Index, Message>>...};
  return kDecoders[place](payload);
}

}  // namespace

FrameBytes encode_frame(const Message& message, std::uint8_t sequence, Address sender) {
  const MessageInfo& info = kDialect[message.index()];
  FrameBytes frame;
  std::uint8_t* bytes = frame.bytes.data();
  const std::uint8_t header[kFrameHeader] = {kFrameStart,   info.length,      sequence,
                                             sender.system, sender.component, info.id};
  std::copy(std::begin(header), std::end(header), bytes);
  std::visit([&](const auto& content) { content.describe(content, Writer(bytes + kFrameHeader)); }, message);
  const std::uint16_t crc = checksum(bytes, info.length, info.crc_extra);
  bytes[kFrameHeader + info.length] = static_cast<std::uint8_t>(crc & 0xFFU);
  bytes[kFrameHeader + info.length + 1] = static_cast<std::uint8_t>(crc >> 8U);
  frame.size = kFrameOverhead + info.length;
  return frame;
}

std::size_t piece_length(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return 0;
  if (bytes[0] != kFrameStart) {
    return static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), kFrameStart) - bytes.begin());
  }
  const std::size_t length = bytes.size() < 2 ? kGreatestFrame : bytes[1] + kFrameOverhead;
  return length <= bytes.size() && bytes.size() > 1 ? length : 0;
}

const MessageInfo* message_of_header(std::span<const std::uint8_t> frame) {
  const std::uint8_t place = kPlaces[frame[5]];
  return place < kDialect.size() && kDialect[place].length == frame[1] ? &kDialect[place] : nullptr;
}

bool sound(std::span<const std::uint8_t> frame, const MessageInfo& info) {
  const std::uint16_t crc = checksum(frame.data(), frame.size() - kFrameOverhead, info.crc_extra);
  return frame[frame.size() - 2] == (crc & 0xFFU) && frame[frame.size() - 1] == crc >> 8U;
}

Frame decode_frame(std::span<const std::uint8_t> frame, const MessageInfo& info) {
  const auto place = static_cast<std::size_t>(&info - kDialect.data());
  return {decoded_as(place, frame.data() + kFrameHeader,
                     std::make_index_sequence<std::variant_size_v<Message>>{}),
          frame[2],
          {frame[3], frame[4]}};
}

}  // namespace ironbird::hil_bridge::rosflight
