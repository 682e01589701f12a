#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hil_bridge/rosflight/messages.hpp"

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

/// Finds frames in a stream of bytes, as the firmware does: one byte after the other, and a frame whose
/// checksum is wrong is dropped with all its bytes, so that a false length can swallow the frames behind it.
///
/// Unlike the firmware it refuses a frame whose length is not that of its message, instead of reading what
/// happens to lie behind its end.
class FrameDecoder {
 public:
  /// Takes one byte. @return the frame that it completes, if any
  std::optional<Frame> push(std::uint8_t byte);

  /// Frames dropped for their checksum.
  int corrupted() const { return corrupted_; }
  /// Frames with a good checksum passed over for their number or length.
  int unknown() const { return unknown_; }

 private:
  std::optional<Frame> finish();

  std::array<std::uint8_t, kGreatestFrame> bytes_{};
  std::size_t size_ = 0;
  int corrupted_ = 0;
  int unknown_ = 0;
};

}  // namespace ironbird::hil_bridge::rosflight
