#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hil_bridge/rosflight/frame_codec.hpp"

namespace ironbird::hil_bridge::rosflight {

/// Finds frames in a stream of bytes as the firmware does: one byte after the other, and a frame whose
/// checksum is wrong is dropped with all its bytes, so that a false length can swallow the frames behind it.
///
/// Unlike the firmware it refuses a frame whose length is not that of its message, instead of reading what
/// happens to lie behind its end.
class FirmwareDecoder {
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
