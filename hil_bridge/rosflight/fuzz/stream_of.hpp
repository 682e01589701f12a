#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hil_bridge/rosflight/frame_codec.hpp"

// Streams of bytes for the fuzz targets of this room: a fuzzer finds headers by itself, but no checksums.

namespace ironbird::hil_bridge::rosflight::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// A frame that was found in a stream.
struct Found {
  std::size_t begin = 0;
  std::size_t size = 0;

  std::size_t end() const { return begin + size; }
  friend bool operator==(const Found&, const Found&) = default;
};

/// What a line carried.
struct Stream {
  Bytes bytes;
  std::vector<Found> intact;  ///< whole frames that were put in, as they lie in `bytes`
};

/// Builds a stream as the input says: whole frames with any content, frames with broken bytes, frames that
/// lost bytes, sound frames of other dialects or lengths, and noise.
Stream stream_of(std::span<const std::uint8_t> input);

/// Is there a frame of the dialect at this place? Worked out bit by bit, without the codec's tables.
bool is_frame(std::span<const std::uint8_t> at);

/// The bytes that this frame would be sent as.
Bytes sent_again(const Frame& frame);

}  // namespace ironbird::hil_bridge::rosflight::fuzz
