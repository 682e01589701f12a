#include "hil_bridge/can/frame_outbox.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::can {

namespace {

unsigned priority_of(const CanFrame& frame) {
  return frame.identifier >> 24U;
}

}  // namespace

bool FrameOutbox::put(const TransferHead& head, std::uint16_t seed, std::span<const std::uint8_t> payload,
                      bool fd, Time deadline) {
  FrameSplitter splitter(head, seed, payload, fd);
  if (size_ + splitter.count() > kCapacity) {
    ++refused_;
    return false;
  }
  while (const std::optional<CanFrame> frame = splitter.next()) insert(*frame, deadline);
  return true;
}

void FrameOutbox::insert(const CanFrame& frame, Time deadline) {
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto place = std::find_if(waiting_.begin(), end, [&](const Waiting& other) {
    return priority_of(other.frame) > priority_of(frame);
  });
  std::copy_backward(place, end, end + 1);
  *place = {frame, deadline};
  ++size_;
}

void FrameOutbox::flush(Time now, transport::FrameBus& bus) {
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto kept =
      std::remove_if(waiting_.begin(), end, [&](const Waiting& one) { return one.deadline < now; });
  expired_ += static_cast<std::uint64_t>(end - kept);
  auto next = waiting_.begin();
  while (next != kept && bus.send(next->frame)) ++next;
  std::copy(next, kept, waiting_.begin());
  size_ = static_cast<std::size_t>(kept - next);
}

}  // namespace ironbird::hil_bridge::can
