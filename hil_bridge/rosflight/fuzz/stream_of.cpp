#include "hil_bridge/rosflight/fuzz/stream_of.hpp"

#include <algorithm>

#include "ci/fuzzing/harness.hpp"

namespace ironbird::hil_bridge::rosflight::fuzz {

namespace {

using fuzzing::Choices;

std::uint16_t crc_over(std::span<const std::uint8_t> bytes, std::uint8_t extra) {
  std::uint16_t crc = kCrcStart;
  for (const std::uint8_t byte : bytes) crc = crc_of(crc, byte);
  return crc_of(crc, extra);
}

/// A frame under a good checksum, whatever it holds.
Bytes sealed(std::uint8_t id, std::uint8_t length, std::uint8_t extra, Choices& choices) {
  Bytes frame = {kFrameStart, length, choices.byte(), choices.byte(), choices.byte(), id};
  const auto payload = choices.take(length);
  frame.insert(frame.end(), payload.begin(), payload.end());
  frame.resize(kFrameHeader + length);
  const std::uint16_t crc = crc_over(std::span(frame).subspan(1), extra);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return frame;
}

Bytes frame_of_the_dialect(Choices& choices) {
  const MessageInfo& info = kDialect[choices.byte() % kDialect.size()];
  return sealed(info.id, info.length, info.crc_extra, choices);
}

void append(Bytes& stream, std::span<const std::uint8_t> more) {
  stream.insert(stream.end(), more.begin(), more.end());
}

}  // namespace

Stream stream_of(std::span<const std::uint8_t> input) {
  Stream stream;
  Choices choices(input);
  while (choices.any_left()) {
    const std::uint8_t what = choices.byte();
    if (what % 8U < 4U) {
      const Bytes frame = frame_of_the_dialect(choices);
      stream.intact.push_back({stream.bytes.size(), frame.size()});
      append(stream.bytes, frame);
    } else if (what % 8U == 4U) {
      Bytes frame = frame_of_the_dialect(choices);
      frame[choices.byte() % frame.size()] ^= static_cast<std::uint8_t>(choices.byte() | 1U);
      append(stream.bytes, frame);
    } else if (what % 8U == 5U) {
      const Bytes frame = frame_of_the_dialect(choices);
      const std::size_t from = choices.byte() % frame.size();
      const std::size_t to = std::min<std::size_t>(from + choices.byte(), frame.size());
      append(stream.bytes, std::span(frame).first(from));
      append(stream.bytes, std::span(frame).subspan(to));
    } else if (what % 8U == 6U) {
      const std::uint8_t id = choices.byte();
      const MessageInfo* const info = find_message(id);
      append(stream.bytes,
             sealed(id, choices.byte(), info == nullptr ? std::uint8_t{0} : info->crc_extra, choices));
    } else {
      append(stream.bytes, choices.take(1U + what / 8U));
    }
  }
  return stream;
}

bool is_frame(std::span<const std::uint8_t> at) {
  if (at.size() < kFrameOverhead || at[0] != kFrameStart) return false;
  const MessageInfo* const info = find_message(at[5]);
  if (info == nullptr || info->length != at[1] || at.size() < kFrameOverhead + info->length) return false;
  const std::size_t checked = kFrameHeader + info->length;
  const std::uint16_t crc = crc_over(at.subspan(1, checked - 1), info->crc_extra);
  return at[checked] == (crc & 0xFFU) && at[checked + 1] == crc >> 8U;
}

Bytes sent_again(const Frame& frame) {
  const FrameBytes again = encode_frame(frame.message, frame.sequence, frame.sender);
  return {again.bytes.begin(), again.bytes.begin() + static_cast<std::ptrdiff_t>(again.size)};
}

}  // namespace ironbird::hil_bridge::rosflight::fuzz
