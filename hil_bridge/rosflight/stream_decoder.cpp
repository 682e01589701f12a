#include "hil_bridge/rosflight/stream_decoder.hpp"

#include <algorithm>
#include <cstring>

#include "hil_bridge/rosflight/dialect.hpp"

namespace ironbird::hil_bridge::rosflight {

std::size_t StreamDecoder::take(std::span<const std::uint8_t> bytes) {
  // What `next` leaves behind is shorter than a frame, so moving it to the front always makes room.
  if (begin_ > 0) {
    std::copy(bytes_.begin() + begin_, bytes_.begin() + end_, bytes_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), kRoom - end_);
  std::copy_n(bytes.begin(), count, bytes_.begin() + end_);
  end_ += count;
  counts_.bytes += count;
  return count;
}

std::optional<Frame> StreamDecoder::next() {
  while (begin_ < end_) {
    const std::uint8_t* const here = bytes_.data() + begin_;
    const std::size_t left = end_ - begin_;
    const void* const start = std::memchr(here, kFrameStart, left);
    if (start == nullptr) {
      skip(left);
      return std::nullopt;
    }
    skip(static_cast<std::size_t>(static_cast<const std::uint8_t*>(start) - here));
    const std::span<const std::uint8_t> rest(bytes_.data() + begin_, end_ - begin_);
    if (rest.size() < kFrameHeader) return std::nullopt;
    const MessageInfo* const info = message_of_header(rest);
    if (info == nullptr) {
      ++counts_.foreign;
      skip(1);
      continue;
    }
    const std::size_t size = kFrameOverhead + info->length;
    if (rest.size() < size) return std::nullopt;
    if (!sound(rest.first(size), *info)) {
      ++counts_.corrupted;
      skip(1);
      continue;
    }
    begin_ += size;
    ++counts_.frames;
    return decode_frame(rest.first(size), *info);
  }
  return std::nullopt;
}

void StreamDecoder::clear() {
  skip(end_ - begin_);
}

void StreamDecoder::skip(std::size_t count) {
  begin_ += count;
  counts_.skipped_bytes += count;
}

}  // namespace ironbird::hil_bridge::rosflight
