#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/rosflight/firmware_decoder.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"

// Frames as bytes and as text, for the tests of this room.

namespace ironbird::hil_bridge::rosflight::test {

inline constexpr Address kCompanion = {1, 50};
inline constexpr Address kFirmware = {1, 250};

inline std::string hex(const FrameBytes& frame) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t k = 0; k < frame.size; ++k) {
    text += kDigits[frame.bytes[k] >> 4U];
    text += kDigits[frame.bytes[k] & 15U];
  }
  return text;
}

inline std::vector<std::uint8_t> bytes(const FrameBytes& frame) {
  return {frame.bytes.begin(), frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size)};
}

inline std::vector<Frame> decode(FirmwareDecoder& decoder, const std::vector<std::uint8_t>& stream) {
  std::vector<Frame> frames;
  for (const std::uint8_t byte : stream) {
    if (const auto frame = decoder.push(byte)) frames.push_back(*frame);
  }
  return frames;
}

inline std::vector<Frame> decode(StreamDecoder& decoder, const std::vector<std::uint8_t>& stream) {
  std::vector<Frame> frames;
  decoder.push(stream, [&](const Frame& frame) { frames.push_back(frame); });
  return frames;
}

}  // namespace ironbird::hil_bridge::rosflight::test
