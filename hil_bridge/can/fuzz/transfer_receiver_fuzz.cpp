// Whatever comes over a bus: transfers of a good sender arrive, each once and whole, between the frames of
// any number of others; and every payload that arrives is refused, or becomes a message that lies on the wire
// as it always did.

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "ci/fuzzing/harness.hpp"
#include "hil_bridge/can/dronecan_messages.hpp"

namespace ironbird::fuzzing {

namespace {

using namespace hil_bridge::can;

constexpr std::uint8_t kOwnNode = 10;
/// Nothing helps against a sender who takes another's number: the others have any but this.
constexpr std::uint8_t kGoodNode = 42;

constexpr std::array kSubscriptions = {
    subscription<NodeStatus>(),           subscription<GetNodeInfoRequest>(),
    subscription<GetNodeInfoResponse>(),  subscription<RawCommand>(),
    subscription<RpmCommand>(),           subscription<EscStatus>(),
    subscription<ArmingStatus>(),         subscription<Allocation>(),
    subscription<GetSetRequest>(),        subscription<GetSetResponse>(),
    subscription<ExecuteOpcodeRequest>(), subscription<ExecuteOpcodeResponse>(),
    subscription<EscStatusExtended>(),    subscription<RestartNodeRequest>(),
    subscription<RestartNodeResponse>()};

template <class M>
void decode_and_encode(const ReceivedTransfer& transfer) {
  if (transfer.head.data_type_id != M::kType.key.data_type_id || transfer.head.kind != M::kType.key.kind)
    return;
  const std::optional<M> message = decode<M>(transfer.payload, transfer.fd);
  if (!message) return;
  const Payload<M> once = encode(*message, transfer.fd);
  require(once.size <= transfer.payload.size(), "a message needs no more bytes than it came in");
  const std::optional<M> again = decode<M>(once.view(), transfer.fd);
  require(again.has_value(), "what has been decoded can be sent");
  const Payload<M> twice = encode(*again, transfer.fd);
  require(twice.size == once.size && std::equal(once.bytes.begin(), once.bytes.end(), twice.bytes.begin()),
          "a message that is sent on stays the same");
}

template <class... M>
void decode_as_what_it_is(const ReceivedTransfer& transfer) {
  (decode_and_encode<M>(transfer), ...);
}

/// Any frame, or one of a type that is listened to with any tail.
CanFrame hostile_frame(Choices& choices) {
  const std::uint8_t shape = choices.byte();
  CanFrame frame;
  frame.fd = (shape & 1U) != 0;
  frame.extended = (shape & 2U) == 0;
  frame.remote = (shape & 12U) == 4U;
  frame.error = (shape & 12U) == 8U;
  const std::uint8_t length = choices.byte();
  frame.size = static_cast<std::uint8_t>(length % (frame.fd ? kFdLength + 1 : kClassicLength + 1));
  if ((shape & 128U) != 0) {
    frame.identifier = choices.number<std::uint32_t>() & kGreatestIdentifier;
  } else {
    TransferHead head;
    const TypeKey type = kSubscriptions[choices.byte() % kSubscriptions.size()].type;
    head.kind = type.kind;
    head.data_type_id = type.data_type_id;
    head.source = choices.byte() & 0x7FU;
    head.destination = kOwnNode;
    frame.identifier = identifier_of(head);
  }
  if ((frame.identifier & 0x7FU) == kGoodNode) frame.identifier ^= 1U;
  const auto data = choices.take(frame.size);
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// Sends one transfer of a single kind after the other, of any length that the type can have, and may send
/// any frame twice, as a bus does whose acknowledgement was lost.
class GoodSender {
 public:
  CanFrame next(Choices& choices) {
    if (last_ && choices.byte() % 8U == 0U) return *last_;
    if (pending_.empty()) begin(choices);
    last_ = pending_.front();
    pending_.erase(pending_.begin());
    if (pending_.empty()) ++sent_;
    return *last_;
  }
  /// Nobody repeats a frame after seconds.
  void pause() { last_.reset(); }
  bool between_transfers() const { return pending_.empty(); }
  int sent() const { return sent_; }

  void arrived(const ReceivedTransfer& transfer) {
    ++received_;
    require(received_ == sent_, "each transfer of a good sender arrives once, with its last frame");
    require(transfer.payload.size() >= payload_.size() &&
                std::equal(payload_.begin(), payload_.end(), transfer.payload.begin()),
            "a transfer arrives as it was sent");
    require(std::all_of(transfer.payload.begin() + static_cast<std::ptrdiff_t>(payload_.size()),
                        transfer.payload.end(), [](std::uint8_t byte) { return byte == 0; }),
            "what fills a frame is zero");
  }
  int received() const { return received_; }

 private:
  void begin(Choices& choices) {
    const Subscription good = subscription<GetNodeInfoResponse>();
    const bool fd = choices.flag();
    const auto payload = choices.take(choices.below(good.capacity + 1U));
    payload_.assign(payload.begin(), payload.end());
    FrameSplitter splitter({16, good.type.kind, good.type.data_type_id, kGoodNode, kOwnNode, id_}, good.seed,
                           payload_, fd);
    while (const auto frame = splitter.next()) pending_.push_back(*frame);
    id_ = (id_ + 1U) & 0x1FU;
  }

  std::vector<std::uint8_t> payload_;
  std::vector<CanFrame> pending_;
  std::optional<CanFrame> last_;
  std::uint8_t id_ = 0;
  int sent_ = 0;
  int received_ = 0;
};

}  // namespace

void check(std::span<const std::uint8_t> input) {
  Choices choices(input);
  TransferReceiver receiver(kOwnNode, kSubscriptions);
  GoodSender good;
  Time now{};
  while (choices.any_left()) {
    const std::uint8_t what = choices.byte();
    // A transfer that takes longer than two seconds is given up, rightly: long pauses lie between two.
    if (good.between_transfers() && what % 16U == 15U) {
      now += std::chrono::seconds(choices.byte());
      good.pause();
    }
    now += std::chrono::microseconds(100);
    const CanFrame frame = what % 2U == 0U ? good.next(choices) : hostile_frame(choices);
    const auto transfer = receiver.push(frame, now);
    if (!transfer) continue;
    const bool from_good = transfer->head.source == kGoodNode;
    require(from_good == (what % 2U == 0U), "a transfer comes from who sent its last frame");
    require(transfer->begun <= now && now - transfer->begun <= kTransferTimeout,
            "a transfer takes no longer than it may");
    if (from_good) good.arrived(*transfer);
    decode_as_what_it_is<NodeStatus, GetNodeInfoRequest, GetNodeInfoResponse, RawCommand, RpmCommand,
                         EscStatus, EscStatusExtended, ArmingStatus, Allocation, GetSetRequest,
                         GetSetResponse, ExecuteOpcodeRequest, ExecuteOpcodeResponse, RestartNodeRequest,
                         RestartNodeResponse>(*transfer);
  }
  require(good.received() == good.sent(), "every transfer of a good sender arrives");
}

}  // namespace ironbird::fuzzing
