#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "hil_bridge/can/dronecan_messages.hpp"

// Frames without sense or meant to harm, in numbers. What is counted besides: allocations.

namespace {
std::size_t allocations = 0;
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace ironbird::hil_bridge::can {
namespace {

constexpr int kFrames = 1'000'000;
constexpr std::uint8_t kAttackedNode = 10;
/// The one good sender. Hostile frames carry any other number: nothing helps against one's own name.
constexpr std::uint8_t kGoodNode = 42;

/// splitmix64
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::uint64_t roll() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
    return z ^ z >> 31U;
  }
  std::uint64_t below(std::uint64_t n) { return roll() % n; }

 private:
  std::uint64_t state_;
};

constexpr std::array kSubscriptions = {subscription<NodeStatus>(),
                                       subscription<GetNodeInfoRequest>(),
                                       subscription<GetNodeInfoResponse>(),
                                       subscription<RawCommand>(),
                                       subscription<EscStatus>(),
                                       subscription<GetSetRequest>(),
                                       subscription<ExecuteOpcodeRequest>(),
                                       subscription<Allocation>()};

/// Any frame, or, `close` to what is listened to, one with a good type, a bad sender and a rolled tail.
CanFrame hostile_frame(Dice& dice, bool close) {
  CanFrame frame;
  frame.extended = close || dice.below(8) != 0;
  frame.fd = dice.below(4) == 0;
  frame.remote = !close && dice.below(16) == 0;
  frame.error = !close && dice.below(16) == 0;
  frame.size = static_cast<std::uint8_t>(dice.below(frame.fd ? 65 : 9));
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(dice.roll());
  TransferHead head;
  head.priority = static_cast<std::uint8_t>(dice.below(32));
  const TypeKey type = kSubscriptions[dice.below(kSubscriptions.size())].type;
  head.kind = type.kind;
  head.data_type_id = type.data_type_id;
  head.source = static_cast<std::uint8_t>(dice.below(128));
  head.destination = kAttackedNode;
  frame.identifier = close ? identifier_of(head) : static_cast<std::uint32_t>(dice.below(1U << 29U));
  if ((frame.identifier & 0x7FU) == kGoodNode) frame.identifier ^= 1U;
  return frame;
}

/// Whatever it is, decoding it may refuse it and do nothing else.
template <class... M>
void decode_as_anything(const ReceivedTransfer& transfer) {
  ((void)decode<M>(transfer.payload, transfer.fd), ...);
}

class HostileBusTest : public ::testing::TestWithParam<bool> {};

TEST_P(HostileBusTest, LetsGoodTransfersThroughWithoutAnAllocation) {
  Dice dice(20261122);
  TransferReceiver receiver(kAttackedNode, kSubscriptions);
  const EscStatus status = {.error_count = 3, .voltage = 15.5F, .rpm = 4321, .esc_index = 2};
  const Payload<EscStatus> payload = encode(status);
  constexpr Subscription kGood = subscription<EscStatus>();
  std::uint8_t id = 0;
  int sent = 0;
  int received = 0;
  const std::size_t before = allocations;
  for (int k = 0; k < kFrames;) {
    FrameSplitter splitter({16, kGood.type.kind, kGood.type.data_type_id, kGoodNode, 0, id}, kGood.seed,
                           payload.view());
    while (const auto frame = splitter.next()) {
      const Time stamp = std::chrono::microseconds(131) * k;
      for (const std::uint64_t until = dice.below(20); static_cast<std::uint64_t>(k) % 20 != until; ++k) {
        const auto transfer = receiver.push(hostile_frame(dice, GetParam()), stamp);
        if (!transfer) continue;
        ASSERT_NE(transfer->head.source, kGoodNode);
        decode_as_anything<NodeStatus, GetNodeInfoRequest, GetNodeInfoResponse, RawCommand, RpmCommand,
                           EscStatus, EscStatusExtended, GetSetRequest, GetSetResponse, ExecuteOpcodeRequest,
                           Allocation, ArmingStatus>(*transfer);
      }
      ++k;
      const auto transfer = receiver.push(*frame, stamp);
      if (transfer && transfer->head.source == kGoodNode) {
        const std::optional<EscStatus> arrived = decode<EscStatus>(transfer->payload);
        received += arrived && arrived->rpm == status.rpm && arrived->voltage == status.voltage ? 1 : 0;
      }
    }
    ++sent;
    id = (id + 1U) % 32U;
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(sent, 10'000);
  EXPECT_EQ(received, sent);
}

INSTANTIATE_TEST_SUITE_P(Frames, HostileBusTest, ::testing::Values(false, true),
                         [](const auto& param) { return param.param ? "CloseToGoodOnes" : "OfAnyKind"; });

}  // namespace
}  // namespace ironbird::hil_bridge::can
