#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hil_bridge/can/can_frame.hpp"

// DroneCAN (UAVCAN v0) transfers: how a payload becomes frames and frames become a payload. What a payload
// says is the business of dronecan_messages.hpp.

namespace ironbird::hil_bridge::can {

inline constexpr std::uint8_t kGreatestNode = 127;
/// A receiver forgets what it knows of a sender when this much has passed since the last transfer began.
inline constexpr Time kTransferTimeout = std::chrono::seconds(2);

/// Broadcast, or one half of a service. Message and service numbers are separate.
enum class TransferKind : std::uint8_t { kMessage, kRequest, kResponse };

/// Everything about a transfer but its payload.
struct TransferHead {
  std::uint8_t priority = 16;
  TransferKind kind = TransferKind::kMessage;
  std::uint16_t data_type_id = 0;
  std::uint8_t source = 0;
  std::uint8_t destination = 0;
  std::uint8_t transfer_id = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("priority", self.priority, "1", "0 most urgent, 31 least");
    visit("kind", self.kind, "1", "message, request or response");
    visit("data_type_id", self.data_type_id, "1", "number of the type among the messages or the services");
    visit("source", self.source, "1", "node 1 to 127, 0 anonymous");
    visit("destination", self.destination, "1", "node 1 to 127 of a service, 0 of a message");
    visit("transfer_id", self.transfer_id, "1", "0 to 31, counted by the sender");
  }
  friend constexpr bool operator==(const TransferHead&, const TransferHead&) = default;
};

/// The 29-bit identifier of a transfer's frames.
/// @param discriminator  of an anonymous message: 14 bits by which senders without a number avoid each other
std::uint32_t identifier_of(const TransferHead& head, std::uint16_t discriminator = 0);

/// What an identifier says, the transfer id aside. Of an anonymous message only the lowest two bits of the
/// type are known. Nothing when it is none of DroneCAN's: a service from or to nobody.
std::optional<TransferHead> head_of(std::uint32_t identifier);

/// CRC-16/CCITT-FALSE, one byte more.
constexpr std::uint16_t crc_of(std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ (byte << 8U));
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint16_t>((crc & 0x8000U) != 0U ? (crc << 1U) ^ 0x1021U : crc << 1U);
  }
  return crc;
}
inline constexpr std::uint16_t kCrcStart = 0xFFFF;

/// The CRC before the first byte of the payload, by which both sides find out that they mean different types.
constexpr std::uint16_t crc_seed(std::uint64_t signature) {
  std::uint16_t crc = kCrcStart;
  for (unsigned k = 0; k < 8; ++k) crc = crc_of(crc, static_cast<std::uint8_t>(signature >> (8U * k)));
  return crc;
}

/// Cuts one transfer into frames. Keeps a view of the payload, which has to outlive it.
class FrameSplitter {
 public:
  /// @param head     of an anonymous transfer the payload must fit into one frame
  /// @param seed     see crc_seed
  /// @param fd       CAN FD frames with bit-rate switch instead of classic ones; pads with zeros to a length
  /// that exists
  /// @param discriminator  of an anonymous transfer; without one the payload's checksum
  FrameSplitter(const TransferHead& head, std::uint16_t seed, std::span<const std::uint8_t> payload,
                bool fd = false, std::optional<std::uint16_t> discriminator = std::nullopt);

  /// The next frame, oldest first, or nothing when all were made.
  std::optional<CanFrame> next();

  /// Frames of the whole transfer.
  std::size_t count() const { return std::max<std::size_t>((total_ + piece_ - 1) / piece_, 1); }

 private:
  std::uint8_t byte_at(std::size_t place) const;

  std::span<const std::uint8_t> payload_;
  std::size_t piece_;      // data bytes of a full frame, without the tail
  std::size_t total_ = 0;  // bytes of the sequence that is cut, CRC and padding included
  std::size_t done_ = 0;
  std::uint32_t identifier_;
  std::uint16_t crc_ = 0;
  std::uint8_t transfer_id_;
  bool fd_;
  bool multiple_;
  bool toggle_ = false;
  bool finished_ = false;
};

/// One number of one half of a service, or of a message.
struct TypeKey {
  std::uint16_t data_type_id = 0;
  TransferKind kind = TransferKind::kMessage;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("data_type_id", self.data_type_id, "1", "number of the type");
    visit("kind", self.kind, "1", "message, request or response");
  }
  friend constexpr bool operator==(const TypeKey&, const TypeKey&) = default;
};

/// The transfer ids of one node: a counter for each type, kind and destination. A response has none of its
/// own, it repeats its request's.
class TransferIds {
 public:
  /// @param types  all that will ever be asked for
  explicit TransferIds(std::span<const TypeKey> types);

  /// The id of the next transfer; 0 always for a type that was not named.
  std::uint8_t next(TypeKey type, std::uint8_t destination);

 private:
  std::vector<TypeKey> types_;
  std::vector<std::array<std::uint8_t, kGreatestNode + 1>> counters_;
};

/// What a receiver listens to.
struct Subscription {
  TypeKey type;
  std::uint16_t seed = 0;
  std::uint16_t capacity = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("type", self.type, "", "which transfers");
    visit("seed", self.seed, "1", "see crc_seed");
    visit("capacity", self.capacity, "byte", "longest payload");
  }
};

/// A transfer that arrived whole. The payload is valid until the receiver is given its next frame.
struct ReceivedTransfer {
  TransferHead head;
  std::span<const std::uint8_t> payload;
  Time begun{};
  bool fd = false;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("head", self.head, "", "from whom, to whom, what");
    visit("payload", self.payload, "1", "the message's bytes; of CAN FD with padding");
    visit("begun", self.begun, "ns", "stamp of its first frame");
    visit("fd", self.fd, "1", "came in CAN FD frames");
  }
};

/// What became of the frames that a receiver was given.
struct TransferCounters {
  std::uint64_t transfers = 0;
  std::uint64_t not_ours = 0;
  std::uint64_t missed_start = 0;
  std::uint64_t unexpected = 0;
  std::uint64_t abandoned = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t too_long = 0;

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("transfers", self.transfers, "1", "transfers that arrived whole");
    visit("not_ours", self.not_ours, "1",
          "frames of other protocols, types or destinations, and error frames");
    visit("missed_start", self.missed_start, "1", "frames of transfers whose beginning was not heard");
    visit("unexpected", self.unexpected, "1",
          "frames dropped for their toggle or transfer id: repeated or out of order");
    visit("abandoned", self.abandoned, "1", "transfers that stayed incomplete");
    visit("corrupted", self.corrupted, "1", "transfers dropped for their checksum");
    visit("too_long", self.too_long, "1", "transfers longer than their type can be");
  }
};

/// Puts the frames of many senders together. Its memory is made at the beginning, one place for each
/// subscription and sender, so that no traffic, however hostile, can exhaust it or push a good transfer out.
///
/// Does not interpret payloads and does not know 11-bit identifiers, remote frames and error frames, which it
/// ignores.
class TransferReceiver {
 public:
  /// @param own_node  1 to 127, services for others are ignored; 0 for a node that has none yet
  TransferReceiver(std::uint8_t own_node, std::span<const Subscription> subscriptions);

  /// Takes one frame. @return the transfer that it completes, if any
  /// @param stamp  when it arrived; frames are given in the order of arrival
  std::optional<ReceivedTransfer> push(const CanFrame& frame, Time stamp);

  /// Another number from now on.
  void set_own_node(std::uint8_t own_node) { own_node_ = own_node; }

  const TransferCounters& counters() const { return counters_; }

 private:
  struct Session {
    Time begun{};
    bool heard = false;
    bool open = false;  // a transfer has begun and not ended
    bool fd = false;
    bool toggle = false;
    bool overlong = false;
    std::uint8_t expected = 0;
    std::uint16_t size = 0;
  };
  struct Channel {
    Subscription subscription;
    std::size_t stride = 0;
    std::vector<Session> sessions;
    std::vector<std::uint8_t> bytes;
  };

  Channel* find(TypeKey type);
  bool admit(Session& session, const CanFrame& frame, Time stamp);
  std::optional<ReceivedTransfer> finish(const Channel& channel, Session& session, const TransferHead& head,
                                         bool single);
  std::optional<ReceivedTransfer> take_anonymous(Channel& channel, const CanFrame& frame,
                                                 const TransferHead& head, Time stamp);

  std::uint8_t own_node_;
  std::vector<Channel> channels_;
  TransferCounters counters_;
};

}  // namespace ironbird::hil_bridge::can
