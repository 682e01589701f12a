#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hil_bridge/rosflight/frame_codec.hpp"

namespace ironbird::hil_bridge::rosflight {

/// What a decoder has met since its start.
struct DecoderCounts {
  std::uint64_t bytes = 0;
  std::uint64_t frames = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t foreign = 0;
  std::uint64_t skipped_bytes = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("bytes", self.bytes, "byte", "taken");
    visit("frames", self.frames, "1", "decoded");
    visit("corrupted", self.corrupted, "1", "frames of the dialect whose checksum was wrong");
    visit("foreign", self.foreign, "1", "start bytes with a number or length that is not of the dialect");
    visit("skipped_bytes", self.skipped_bytes, "byte", "that were not part of a decoded frame");
  }
};

/// Finds frames in a stream of bytes and loses none that arrived whole.
///
/// A frame begins with the start byte and a header whose number and length belong together; a false length is
/// therefore seen at once. When a checksum is wrong only the start byte is given up, and what follows it is
/// looked through again: a frame that lost bytes takes none of its neighbours with it. (The firmware's own
/// parser drops the whole stretch: see FirmwareDecoder.) Work is bounded: a byte is gone over once for every
/// header of the dialect that claims it, and headers cannot lie closer than three bytes.
///
/// Allocates nothing.
class StreamDecoder {
 public:
  /// Takes as many of `bytes` as there is room for, at least one. @return how many
  std::size_t take(std::span<const std::uint8_t> bytes);

  /// The next frame among the bytes taken, or none: then there is room for more.
  std::optional<Frame> next();

  /// Takes all of `bytes`, and gives every frame to `sink`.
  template <class Sink>
  void push(std::span<const std::uint8_t> bytes, Sink&& sink) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(take(bytes));
      while (const std::optional<Frame> frame = next()) sink(*frame);
    }
  }

  /// Forgets what has been taken and not decoded: after the line was cut, two halves do not belong together.
  void clear();

  const DecoderCounts& counts() const { return counts_; }

 private:
  void skip(std::size_t count);

  static constexpr std::size_t kRoom = 4096;
  std::array<std::uint8_t, kRoom> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  DecoderCounts counts_;
};

}  // namespace ironbird::hil_bridge::rosflight
