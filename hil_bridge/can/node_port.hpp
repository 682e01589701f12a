#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "hil_bridge/can/frame_outbox.hpp"
#include "hil_bridge/can/serialisation.hpp"

namespace ironbird::hil_bridge::can {

/// A transfer that is not out after this is given up.
inline constexpr Time kSendLifetime = std::chrono::seconds(1);

/// A node says how it is this often.
inline constexpr Time kStatusPeriod = std::chrono::seconds(1);

/// Of the messages by which nodes come by their numbers.
inline constexpr std::uint8_t kAllocationPriority = 30;

/// How one node sends and receives messages: its number, its transfer ids, its outbox, its receiver.
class NodePort {
 public:
  /// @param node  1 to 127, 0 for a node that has none yet and may send short messages of the types 0 to 3
  /// alone
  /// @param in    what it listens to
  /// @param out   the messages and requests that it will send
  /// @param fd    sends CAN FD frames; a response goes the way of its request
  NodePort(std::uint8_t node, std::span<const Subscription> in, std::span<const TypeKey> out, bool fd)
      : receiver_(node, in), ids_(out), node_(node), fd_(fd) {}

  /// @param destination  of a request, 0 of a message
  template <class M>
  bool send(const M& message, std::uint8_t priority, Time now, std::uint8_t destination = 0,
            Time lifetime = kSendLifetime) {
    const std::uint8_t id = ids_.next(M::kType.key, destination);
    return put({priority, M::kType.key.kind, M::kType.key.data_type_id, node_, destination, id}, message, fd_,
               now + lifetime);
  }

  template <class M>
  bool respond(const M& message, const ReceivedTransfer& request, Time now) {
    const TransferHead& head = request.head;
    return put({head.priority, M::kType.key.kind, head.data_type_id, node_, head.source, head.transfer_id},
               message, request.fd, now + kSendLifetime);
  }

  std::optional<ReceivedTransfer> push(const ReceivedFrame& frame) {
    return receiver_.push(frame.frame, frame.stamp);
  }
  void flush(Time now, transport::FrameBus& bus) { outbox_.flush(now, bus); }

  std::uint8_t node() const { return node_; }
  void set_node(std::uint8_t node) {
    node_ = node;
    receiver_.set_own_node(node);
  }
  const FrameOutbox& outbox() const { return outbox_; }
  const TransferReceiver& receiver() const { return receiver_; }

 private:
  template <class M>
  bool put(const TransferHead& head, const M& message, bool fd, Time deadline) {
    constexpr std::uint16_t kSeed = crc_seed(M::kType.signature);
    const Payload<M> payload = encode(message, fd);
    return outbox_.put(head, kSeed, payload.view(), fd, deadline);
  }

  TransferReceiver receiver_;
  TransferIds ids_;
  FrameOutbox outbox_;
  std::uint8_t node_;
  bool fd_;
};

/// Is the transfer one of these?
template <class M>
bool holds(const ReceivedTransfer& transfer) {
  return M::kType.key == TypeKey{transfer.head.data_type_id, transfer.head.kind};
}

/// The message of a transfer, when it is one of these and makes sense.
template <class M>
std::optional<M> message_of(const ReceivedTransfer& transfer) {
  if (!holds<M>(transfer)) return std::nullopt;
  return decode<M>(transfer.payload, transfer.fd);
}

}  // namespace ironbird::hil_bridge::can
