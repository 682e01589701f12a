#include "hil_bridge/rosflight/firmware_decoder.hpp"

#include <span>

namespace ironbird::hil_bridge::rosflight {

namespace {

constexpr std::size_t kLengthKnown = 2;

}  // namespace

std::optional<Frame> FirmwareDecoder::push(std::uint8_t byte) {
  if (size_ == 0 && byte != kFrameStart) return std::nullopt;
  bytes_[size_++] = byte;
  if (size_ < kLengthKnown || size_ < kFrameOverhead + bytes_[1]) return std::nullopt;
  return finish();
}

std::optional<Frame> FirmwareDecoder::finish() {
  const std::span<const std::uint8_t> frame(bytes_.data(), size_);
  const MessageInfo* const info = find_message(frame[5]);
  const bool whole = sound(frame, info == nullptr ? MessageInfo{} : *info);
  size_ = 0;
  if (!whole) {
    ++corrupted_;
    if (frame.back() == kFrameStart) bytes_[size_++] = kFrameStart;
    return std::nullopt;
  }
  if (message_of_header(frame) == nullptr) {
    ++unknown_;
    return std::nullopt;
  }
  return decode_frame(frame, *info);
}

}  // namespace ironbird::hil_bridge::rosflight
