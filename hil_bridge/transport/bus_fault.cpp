#include "hil_bridge/transport/bus_fault.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace ironbird::hil_bridge::transport {

namespace {

constexpr std::size_t kFaultEventQueue = 64;
constexpr std::size_t kHead = 5;  // identifier and kind, before the data
constexpr std::uint32_t kExtended = 1U << 31U;
constexpr std::uint32_t kRemote = 1U << 30U;
constexpr std::uint8_t kFd = 1;
constexpr std::uint8_t kBitRateSwitch = 2;

/// A frame as a piece: whatever bit of it is spoilt means something.
struct Piece {
  std::array<std::uint8_t, kHead + can::kFdLength> bytes{};
  std::size_t size = 0;
};

Piece piece_of(const CanFrame& frame) {
  Piece piece;
  const std::uint32_t head =
      frame.identifier | (frame.extended ? kExtended : 0U) | (frame.remote ? kRemote : 0U);
  for (unsigned k = 0; k < 4; ++k) piece.bytes[k] = static_cast<std::uint8_t>(head >> (8U * k));
  piece.bytes[4] =
      static_cast<std::uint8_t>((frame.fd ? kFd : 0U) | (frame.bit_rate_switch ? kBitRateSwitch : 0U));
  std::copy_n(frame.data.begin(), frame.size, piece.bytes.begin() + kHead);
  piece.size = kHead + frame.size;
  return piece;
}

/// Noise that looks like a frame: up to four bytes of identifier, then data.
CanFrame noise_frame(std::span<const std::uint8_t> bytes) {
  CanFrame frame;
  const std::size_t head = std::min<std::size_t>(bytes.size(), 4);
  for (std::size_t k = 0; k < head; ++k) frame.identifier |= std::uint32_t{bytes[k]} << (8U * k);
  frame.identifier &= can::kGreatestIdentifier;
  frame.size = static_cast<std::uint8_t>(std::min(bytes.size() - head, can::kClassicLength));
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(head), frame.size, frame.data.begin());
  return frame;
}

}  // namespace

BusFault::BusFault(FrameBus& bus, const LinkFaultConfig& config, std::uint64_t seed)
    : bus_(bus),
      outgoing_(config.outgoing, seed, "bus/outgoing"),
      incoming_(config.incoming, seed, "bus/incoming"),
      events_(kFaultEventQueue) {}

void BusFault::advance(Time now) {
  now_ = now;
  if (!up_ && now_ >= closed_until_) {
    up_ = true;
    events_.push({BusEventKind::kUp, now_});
  }
  while (const std::optional<ReceivedFrame> received = bus_.receive()) {
    if (!up_) continue;
    const Piece piece = piece_of(received->frame);
    if (!incoming_.put(std::span(piece.bytes).first(piece.size), now_)) cut(incoming_.faults().hang_up_time);
  }
  send_due();
}

void BusFault::set(const LinkFaultConfig& config) {
  outgoing_.set(config.outgoing);
  incoming_.set(config.incoming);
}

void BusFault::stand_still(Time until) {
  outgoing_.stand_still(until);
  incoming_.stand_still(until);
}

void BusFault::hang_up(Time until) {
  cut(until - now_);
}

void BusFault::cut(Time closed_for) {
  if (up_) events_.push({BusEventKind::kDown, now_});
  up_ = false;
  closed_until_ = std::max(closed_until_, now_ + closed_for);
  outgoing_.clear();
  incoming_.clear();
}

bool BusFault::send(const CanFrame& frame) {
  if (!up_ || !can::is_sendable(frame) || (frame.fd && !fd())) return false;
  const Piece piece = piece_of(frame);
  if (!outgoing_.put(std::span(piece.bytes).first(piece.size), now_)) {
    cut(outgoing_.faults().hang_up_time);
    return true;
  }
  send_due();
  return true;
}

void BusFault::send_due() {
  while (const FaultyDirection::Due* const piece = outgoing_.due(now_)) {
    const std::optional<CanFrame> frame = frame_of(*piece);
    // A full queue keeps the rest waiting.
    if (frame && !bus_.send(*frame) && bus_.state() != BusState::kDown && bus_.state() != BusState::kOff) {
      return;
    }
    outgoing_.pop();
  }
}

std::optional<ReceivedFrame> BusFault::receive() {
  while (const FaultyDirection::Due* const piece = incoming_.due(now_)) {
    const std::optional<CanFrame> frame = frame_of(*piece);
    const Time stamp = piece->when;
    incoming_.pop();
    if (frame) return ReceivedFrame{*frame, stamp};
  }
  return std::nullopt;
}

std::optional<BusEvent> BusFault::take_event() {
  const std::optional<BusEvent> own = events_.pop();
  return own ? own : bus_.take_event();
}

std::optional<CanFrame> BusFault::frame_of(const FaultyDirection::Due& piece) const {
  CanFrame frame;
  if (piece.noise || piece.bytes.size() < kHead) {
    frame = noise_frame(piece.bytes);
  } else {
    std::uint32_t head = 0;
    for (unsigned k = 0; k < 4; ++k) head |= std::uint32_t{piece.bytes[k]} << (8U * k);
    frame.extended = (head & kExtended) != 0;
    frame.remote = (head & kRemote) != 0;
    frame.identifier = head & can::kGreatestIdentifier;
    frame.fd = (piece.bytes[4] & kFd) != 0;
    frame.bit_rate_switch = (piece.bytes[4] & kBitRateSwitch) != 0;
    frame.size = static_cast<std::uint8_t>(piece.bytes.size() - kHead);
    std::copy_n(piece.bytes.begin() + kHead, frame.size, frame.data.begin());
  }
  const bool carried = can::is_sendable(frame) && (fd() || !frame.fd);
  return carried ? std::optional(frame) : std::nullopt;
}

}  // namespace ironbird::hil_bridge::transport
