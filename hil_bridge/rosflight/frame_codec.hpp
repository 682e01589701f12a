#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hil_bridge/rosflight/dialect.hpp"

namespace ironbird::hil_bridge::rosflight {

/// Who sends a frame.
struct Address {
  std::uint8_t system = 1;
  std::uint8_t component = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("system", self.system, "1", "number of the system");
    visit("component", self.component, "1", "number of its part: 250 the firmware, 50 the companion");
  }
};

inline constexpr std::size_t kFrameOverhead = 8;  ///< bytes of a frame besides its payload
inline constexpr std::size_t kGreatestFrame = 255 + kFrameOverhead;

/// The bytes of one frame.
struct FrameBytes {
  std::array<std::uint8_t, kGreatestFrame> bytes{};
  std::size_t size = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("bytes", self.bytes, "1", "as they go over the wire; the first `size` count");
    visit("size", self.size, "byte", "length of the frame");
  }
};

/// A message as a MAVLink 1 frame. Numbers go as their bits, whatever they are: a NaN survives.
/// @param sequence  the sender's count of frames, which wraps
FrameBytes encode_frame(const Message& message, std::uint8_t sequence, Address sender);

/// A frame that arrived whole.
struct Frame {
  Message message;
  std::uint8_t sequence = 0;
  Address sender;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("message", self.message, "", "what it says");
    visit("sequence", self.sequence, "1", "the sender's count of frames, wraps");
    visit("sender", self.sender, "", "who sent it");
  }
};

inline constexpr std::uint8_t kFrameStart = 0xFE;
inline constexpr std::size_t kFrameHeader = 6;  ///< bytes before the payload

/// How long the frame is that these bytes begin with, sound or not, or what stands before the next start
/// byte; 0: the rest of it has not come yet.
std::size_t piece_length(std::span<const std::uint8_t> bytes);

/// The message whose number and length stand in this header, or null.
/// @param frame  begins with the start byte; at least a header long
const MessageInfo* message_of_header(std::span<const std::uint8_t> frame);

/// Is the checksum at the end of this frame that of its bytes?
bool sound(std::span<const std::uint8_t> frame, const MessageInfo& info);

/// The content of a sound frame.
Frame decode_frame(std::span<const std::uint8_t> frame, const MessageInfo& info);

}  // namespace ironbird::hil_bridge::rosflight
