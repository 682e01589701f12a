#include "hil_bridge/transport/stream_pair.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::transport {

StreamPair::StreamPair(std::size_t room)
    : near_(to_near_, to_far_, room, "near end"), far_(to_far_, to_near_, room, "far end") {}

void StreamPair::hang_up() {
  near_.cut();
  far_.cut();
  to_near_.clear();
  to_far_.clear();
}

std::size_t StreamPair::End::read(std::span<std::uint8_t> to) {
  if (!up_) return 0;
  const std::size_t count = std::min(to.size(), in_.size());
  std::copy_n(in_.begin(), count, to.begin());
  in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::size_t StreamPair::End::write(std::span<const std::uint8_t> from) {
  if (!up_) return 0;
  const std::size_t count = std::min(from.size(), room_ - std::min(room_, out_.size()));
  out_.insert(out_.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

}  // namespace ironbird::hil_bridge::transport
