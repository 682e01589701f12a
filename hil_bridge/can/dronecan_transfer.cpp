#include "hil_bridge/can/dronecan_transfer.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::can {

namespace {

constexpr std::uint8_t kStart = 0x80;
constexpr std::uint8_t kEnd = 0x40;
constexpr std::uint8_t kToggle = 0x20;
constexpr std::uint8_t kIdMask = 0x1F;
constexpr std::size_t kCrcSize = 2;
/// What padding can add to a payload: a frame of 33 bytes becomes one of 48.
constexpr std::size_t kMostFrameFill = 15;

std::uint8_t tail_of(const CanFrame& frame) {
  return frame.data[frame.size - 1U];
}

/// Steps from one transfer id to another.
unsigned distance(unsigned from, unsigned to) {
  return (to - from) & kIdMask;
}

}  // namespace

std::uint32_t identifier_of(const TransferHead& head, std::uint16_t discriminator) {
  const std::uint32_t common =
      static_cast<std::uint32_t>(head.priority & 0x1FU) << 24U | (head.source & 0x7FU);
  if (head.kind != TransferKind::kMessage) {
    const std::uint32_t request = head.kind == TransferKind::kRequest ? 1U : 0U;
    return common | (head.data_type_id & 0xFFU) << 16U | request << 15U | (head.destination & 0x7FU) << 8U |
           1U << 7U;
  }
  if (head.source == 0) return common | (discriminator & 0x3FFFU) << 10U | (head.data_type_id & 3U) << 8U;
  return common | static_cast<std::uint32_t>(head.data_type_id) << 8U;
}

std::optional<TransferHead> head_of(std::uint32_t identifier) {
  TransferHead head;
  head.priority = static_cast<std::uint8_t>(identifier >> 24U & 0x1FU);
  head.source = static_cast<std::uint8_t>(identifier & 0x7FU);
  if ((identifier & 1U << 7U) != 0U) {
    head.kind = (identifier & 1U << 15U) != 0U ? TransferKind::kRequest : TransferKind::kResponse;
    head.data_type_id = static_cast<std::uint16_t>(identifier >> 16U & 0xFFU);
    head.destination = static_cast<std::uint8_t>(identifier >> 8U & 0x7FU);
    if (head.source == 0 || head.destination == 0) return std::nullopt;
    return head;
  }
  const std::uint32_t type = identifier >> 8U & 0xFFFFU;
  head.data_type_id = static_cast<std::uint16_t>(head.source == 0 ? type & 3U : type);
  return head;
}

FrameSplitter::FrameSplitter(const TransferHead& head, std::uint16_t seed,
                             std::span<const std::uint8_t> payload, bool fd,
                             std::optional<std::uint16_t> discriminator)
    : payload_(payload),
      piece_((fd ? kFdLength : kClassicLength) - 1),
      transfer_id_(head.transfer_id & kIdMask),
      fd_(fd),
      multiple_(payload.size() > piece_) {
  std::uint16_t crc = seed;
  for (const std::uint8_t byte : payload) crc = crc_of(crc, byte);
  identifier_ = identifier_of(head, discriminator.value_or(crc));
  const std::size_t bare = payload.size() + (multiple_ ? kCrcSize : 0);
  const std::size_t last = bare % piece_;
  total_ = fd && last != 0 ? bare - last + fd_length(last + 1) - 1 : bare;
  for (std::size_t padding = total_ - bare; padding > 0; --padding) crc = crc_of(crc, 0);
  crc_ = crc;
}

std::uint8_t FrameSplitter::byte_at(std::size_t place) const {
  if (multiple_ && place < kCrcSize) return static_cast<std::uint8_t>(crc_ >> (8U * place));
  if (multiple_) place -= kCrcSize;
  return place < payload_.size() ? payload_[place] : std::uint8_t{0};
}

std::optional<CanFrame> FrameSplitter::next() {
  if (finished_) return std::nullopt;
  const std::size_t size = std::min(piece_, total_ - done_);
  CanFrame frame;
  frame.identifier = identifier_;
  frame.fd = fd_;
  frame.bit_rate_switch = fd_;
  frame.size = static_cast<std::uint8_t>(size + 1);
  for (std::size_t k = 0; k < size; ++k) frame.data[k] = byte_at(done_ + k);
  const bool first = done_ == 0;
  done_ += size;
  finished_ = done_ == total_;
  frame.data[size] = static_cast<std::uint8_t>((first ? kStart : 0U) | (finished_ ? kEnd : 0U) |
                                               (toggle_ ? kToggle : 0U) | transfer_id_);
  toggle_ = !toggle_;
  return frame;
}

TransferIds::TransferIds(std::span<const TypeKey> types)
    : types_(types.begin(), types.end()), counters_(types.size()) {}

std::uint8_t TransferIds::next(TypeKey type, std::uint8_t destination) {
  const auto found = std::find(types_.begin(), types_.end(), type);
  if (found == types_.end()) return 0;
  std::uint8_t& counter = counters_[static_cast<std::size_t>(found - types_.begin())][destination & 0x7FU];
  const std::uint8_t id = counter;
  counter = (counter + 1U) & kIdMask;
  return id;
}

TransferReceiver::TransferReceiver(std::uint8_t own_node, std::span<const Subscription> subscriptions)
    : own_node_(own_node) {
  for (const Subscription& subscription : subscriptions) {
    Channel& channel = channels_.emplace_back();
    channel.subscription = subscription;
    channel.stride = subscription.capacity + kCrcSize + kMostFrameFill;
    channel.sessions.resize(kGreatestNode + 1U);
    channel.bytes.resize(channel.stride * (kGreatestNode + 1U));
  }
}

TransferReceiver::Channel* TransferReceiver::find(TypeKey type) {
  const auto found = std::find_if(channels_.begin(), channels_.end(),
                                  [&](const Channel& channel) { return channel.subscription.type == type; });
  return found == channels_.end() ? nullptr : &*found;
}

std::optional<ReceivedTransfer> TransferReceiver::push(const CanFrame& frame, Time stamp) {
  const bool data =
      frame.extended && !frame.remote && !frame.error && frame.size > 0 && frame.size <= kFdLength;
  std::optional<TransferHead> head = data ? head_of(frame.identifier) : std::nullopt;
  const bool for_us = head && (head->kind == TransferKind::kMessage || head->destination == own_node_);
  Channel* channel = for_us ? find({head->data_type_id, head->kind}) : nullptr;
  if (channel == nullptr) {
    ++counters_.not_ours;
    return std::nullopt;
  }
  const std::uint8_t tail = tail_of(frame);
  head->transfer_id = tail & kIdMask;
  if (head->source == 0) return take_anonymous(*channel, frame, *head, stamp);

  Session& session = channel->sessions[head->source];
  if (!admit(session, frame, stamp)) return std::nullopt;
  std::uint8_t* bytes = channel->bytes.data() + head->source * channel->stride;
  const std::size_t room = channel->stride - session.size;
  const std::size_t size = frame.size - 1U;
  if (size > room) session.overlong = true;
  std::copy_n(frame.data.begin(), std::min(size, room), bytes + session.size);
  session.size = static_cast<std::uint16_t>(session.size + std::min(size, room));
  session.toggle = !session.toggle;
  if ((tail & kEnd) == 0) return std::nullopt;
  return finish(*channel, session, *head, (tail & kStart) != 0);
}

/// Is the frame the one that has to come next? One that begins a transfer may start the session anew.
bool TransferReceiver::admit(Session& session, const CanFrame& frame, Time stamp) {
  const std::uint8_t tail = tail_of(frame);
  const bool start = (tail & kStart) != 0;
  const bool toggle = (tail & kToggle) != 0;
  const auto id = static_cast<std::uint8_t>(tail & kIdMask);
  if (start && toggle) {
    ++counters_.unexpected;
    return false;
  }
  const bool timed_out = stamp - session.begun > kTransferTimeout;
  if (timed_out || (start && session.open)) {
    counters_.abandoned += session.open ? 1 : 0;
    session = {};
  }
  if (!start && !session.open) {
    ++counters_.missed_start;
    return false;
  }
  // The transfer that was completed last is one step behind what is expected: a frame of it is a repetition.
  const bool in_turn = start ? !session.heard || distance(id, session.expected) != 1
                             : id == session.expected && toggle == session.toggle && frame.fd == session.fd;
  if (!in_turn) {
    ++counters_.unexpected;
    return false;
  }
  if (start) session = {.begun = stamp, .heard = true, .open = true, .fd = frame.fd, .expected = id};
  return true;
}

std::optional<ReceivedTransfer> TransferReceiver::finish(const Channel& channel, Session& session,
                                                         const TransferHead& head, bool single) {
  session.open = false;
  session.expected = (session.expected + 1U) & kIdMask;
  std::span<const std::uint8_t> payload{channel.bytes.data() + head.source * channel.stride, session.size};
  if (session.overlong) {
    ++counters_.too_long;
    return std::nullopt;
  }
  if (!single && payload.size() < kCrcSize) {
    ++counters_.corrupted;
    return std::nullopt;
  }
  if (!single) {
    const auto sent = static_cast<std::uint16_t>(payload[0] | payload[1] << 8U);
    payload = payload.subspan(kCrcSize);
    std::uint16_t crc = channel.subscription.seed;
    for (const std::uint8_t byte : payload) crc = crc_of(crc, byte);
    if (crc != sent) {
      ++counters_.corrupted;
      return std::nullopt;
    }
  }
  ++counters_.transfers;
  return ReceivedTransfer{head, payload, session.begun, session.fd};
}

/// Nobody's transfers are single frames, and each stands for itself: there is no sender whose ids could be
/// counted.
std::optional<ReceivedTransfer> TransferReceiver::take_anonymous(Channel& channel, const CanFrame& frame,
                                                                 const TransferHead& head, Time stamp) {
  const std::size_t size = frame.size - 1U;
  if ((tail_of(frame) & ~kIdMask) != (kStart | kEnd)) {
    ++counters_.unexpected;
    return std::nullopt;
  }
  if (size > channel.stride) {
    ++counters_.too_long;
    return std::nullopt;
  }
  std::copy_n(frame.data.begin(), size, channel.bytes.begin());
  ++counters_.transfers;
  return ReceivedTransfer{head, {channel.bytes.data(), size}, stamp, frame.fd};
}

}  // namespace ironbird::hil_bridge::can
