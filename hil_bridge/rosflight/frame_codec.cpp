#include "hil_bridge/rosflight/frame_codec.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <type_traits>
#include <utility>

#include "hil_bridge/rosflight/dialect.hpp"

namespace ironbird::hil_bridge::rosflight {

namespace {

constexpr std::uint8_t kStart = 0xFE;
constexpr std::size_t kHeader = 6;

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
  for (std::size_t k = 1; k < kHeader + length; ++k) crc = crc_of(crc, frame[k]);
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
  const std::uint8_t header[kHeader] = {kStart,        info.length,      sequence,
                                        sender.system, sender.component, info.id};
  std::copy(std::begin(header), std::end(header), bytes);
  std::visit([&](const auto& content) { content.describe(content, Writer(bytes + kHeader)); }, message);
  const std::uint16_t crc = checksum(bytes, info.length, info.crc_extra);
  bytes[kHeader + info.length] = static_cast<std::uint8_t>(crc & 0xFFU);
  bytes[kHeader + info.length + 1] = static_cast<std::uint8_t>(crc >> 8U);
  frame.size = kFrameOverhead + info.length;
  return frame;
}

std::optional<Frame> FrameDecoder::push(std::uint8_t byte) {
  if (size_ == 0 && byte != kStart) return std::nullopt;
  bytes_[size_++] = byte;
  constexpr std::size_t kLengthKnown = 2;
  if (size_ < kLengthKnown || size_ < kFrameOverhead + bytes_[1]) return std::nullopt;
  return finish();
}

std::optional<Frame> FrameDecoder::finish() {
  const std::size_t length = bytes_[1];
  const MessageInfo* info = find_message(bytes_[5]);
  const std::uint16_t crc = checksum(bytes_.data(), length, info == nullptr ? 0 : info->crc_extra);
  const std::uint8_t last = bytes_[size_ - 1];
  const bool sound = bytes_[size_ - 2] == (crc & 0xFFU) && last == crc >> 8U;
  size_ = 0;
  if (!sound) {
    ++corrupted_;
    if (last == kStart) bytes_[size_++] = kStart;
    return std::nullopt;
  }
  if (info == nullptr || info->length != length) {
    ++unknown_;
    return std::nullopt;
  }
  const auto place = static_cast<std::size_t>(info - kDialect.data());
  return Frame{
      decoded_as(place, bytes_.data() + kHeader, std::make_index_sequence<std::variant_size_v<Message>>{}),
      bytes_[2],
      {bytes_[3], bytes_[4]}};
}

}  // namespace ironbird::hil_bridge::rosflight
