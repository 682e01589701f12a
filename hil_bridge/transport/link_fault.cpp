#include "hil_bridge/transport/link_fault.hpp"

#include <algorithm>
#include <array>

namespace ironbird::hil_bridge::transport {

using std::chrono::nanoseconds;

LinkFault::LinkFault(ByteStream& line, const LinkFaultConfig& config, std::uint64_t seed, PieceLength pieces)
    : line_(line),
      outgoing_(config.outgoing, seed, "outgoing"),
      incoming_(config.incoming, seed, "incoming"),
      written_(pieces),
      read_(pieces) {}

void LinkFault::advance(nanoseconds now) {
  now_ = now;
  std::array<std::uint8_t, kReadRoom> bytes;
  // What comes while the line is cut is gone.
  while (const std::size_t count = line_.read(bytes)) {
    if (up_) take(std::span(bytes).first(count));
  }
  send_due();
}

void LinkFault::take(std::span<const std::uint8_t> bytes) {
  const auto put = [this](std::span<const std::uint8_t> piece) { return incoming_.put(piece, now_); };
  if (!read_.take(bytes, put)) cut(incoming_.faults().hang_up_time);
}

void LinkFault::set(const LinkFaultConfig& config) {
  outgoing_.set(config.outgoing);
  incoming_.set(config.incoming);
}

void LinkFault::stand_still(nanoseconds until) {
  outgoing_.stand_still(until);
  incoming_.stand_still(until);
}

void LinkFault::hang_up(nanoseconds until) {
  cut(until - now_);
}

void LinkFault::send_due() {
  while (FaultyDirection::Due* const piece = outgoing_.due(now_)) {
    const std::size_t count = line_.write(piece->bytes);
    if (count < piece->bytes.size()) {  // the line is full: the rest waits
      piece->bytes.erase(piece->bytes.begin(), piece->bytes.begin() + static_cast<std::ptrdiff_t>(count));
      return;
    }
    outgoing_.pop();
  }
}

std::size_t LinkFault::read(std::span<std::uint8_t> to) {
  std::size_t count = 0;
  while (is_up() && count < to.size()) {
    FaultyDirection::Due* const piece = incoming_.due(now_);
    if (piece == nullptr) break;
    const std::size_t part = std::min(piece->bytes.size(), to.size() - count);
    std::copy_n(piece->bytes.begin(), part, to.begin() + static_cast<std::ptrdiff_t>(count));
    count += part;
    if (part < piece->bytes.size()) {
      piece->bytes.erase(piece->bytes.begin(), piece->bytes.begin() + static_cast<std::ptrdiff_t>(part));
      break;
    }
    incoming_.pop();
  }
  return count;
}

std::size_t LinkFault::write(std::span<const std::uint8_t> from) {
  send_due();
  if (!is_up() || waiting() || !outgoing_.has_room(now_)) return 0;
  const auto put = [this](std::span<const std::uint8_t> piece) { return outgoing_.put(piece, now_); };
  const bool holds = written_.take(from, put);
  send_due();
  if (!holds) cut(outgoing_.faults().hang_up_time);
  return from.size();
}

void LinkFault::cut(nanoseconds closed_for) {
  up_ = false;
  closed_until_ = std::max(closed_until_, now_ + closed_for);
  forget();
}

void LinkFault::forget() {
  outgoing_.clear();
  incoming_.clear();
  written_.clear();
  read_.clear();
}

bool LinkFault::reopen() {
  if (now_ < closed_until_) return false;
  if (!line_.is_up()) forget();
  up_ = line_.is_up() || line_.reopen();
  return up_;
}

}  // namespace ironbird::hil_bridge::transport
