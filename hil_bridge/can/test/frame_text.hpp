#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/can/can_frame.hpp"

// Frames as the usual tools write them: 0804060A#E80F407B82E80FC7.

namespace ironbird::hil_bridge::can {

inline std::vector<std::uint8_t> bytes_of(std::string_view digits) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t k = 0; k + 1 < digits.size(); k += 2) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::strtoul(std::string(digits.substr(k, 2)).c_str(), nullptr, 16)));
  }
  return bytes;
}

/// Of a classic frame, or after ## of one of CAN FD with bit-rate switch.
inline CanFrame frame_of(std::string_view text) {
  CanFrame frame;
  const std::size_t mark = text.find('#');
  frame.identifier =
      static_cast<std::uint32_t>(std::strtoul(std::string(text.substr(0, mark)).c_str(), nullptr, 16));
  frame.extended = mark > 3;
  frame.fd = text.substr(mark, 2) == "##";
  frame.bit_rate_switch = frame.fd;
  const std::vector<std::uint8_t> data = bytes_of(text.substr(mark + (frame.fd ? 2 : 1)));
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

inline std::string text_of(const CanFrame& frame) {
  char piece[16];
  std::snprintf(piece, sizeof piece, frame.extended ? "%08X%s" : "%03X%s", frame.identifier,
                frame.fd ? "##" : "#");
  std::string text = piece;
  for (std::size_t k = 0; k < frame.size; ++k) {
    std::snprintf(piece, sizeof piece, "%02X", frame.data[k]);
    text += piece;
  }
  return text;
}

}  // namespace ironbird::hil_bridge::can
