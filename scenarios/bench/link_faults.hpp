#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

#include "hil_bridge/transport/faulty_direction.hpp"

namespace ironbird::scenarios {

/// What an event can make go wrong with a line or a bus, both ways at once.
enum class LinkFaultKind : std::uint8_t {
  kDrop,       ///< frames are lost, `magnitude` their share
  kBurstLoss,  ///< bursts of losses begin, `magnitude` their share of the frames
  kCorrupt,    ///< bytes have a false bit, `magnitude` their share
  kInsert,     ///< noise comes before frames, `magnitude` their share
  kDuplicate,  ///< frames come twice, `magnitude` their share
  kReorder,    ///< frames come after the one behind them, `magnitude` their share
  kLatency,    ///< everything comes `magnitude` seconds later
  kJitter,     ///< everything comes up to `magnitude` seconds later
  kByteRate,   ///< the line carries `magnitude` bytes a second
  kStall,      ///< nothing goes either way for as long as it lasts; nothing is lost
  kHangUp      ///< the line is cut for as long as it lasts
};

constexpr std::array<std::pair<LinkFaultKind, std::string_view>, 11> enumerators(LinkFaultKind) {
  return {{{LinkFaultKind::kDrop, "drop"},
           {LinkFaultKind::kBurstLoss, "burst_loss"},
           {LinkFaultKind::kCorrupt, "corrupt"},
           {LinkFaultKind::kInsert, "insert"},
           {LinkFaultKind::kDuplicate, "duplicate"},
           {LinkFaultKind::kReorder, "reorder"},
           {LinkFaultKind::kLatency, "latency"},
           {LinkFaultKind::kJitter, "jitter"},
           {LinkFaultKind::kByteRate, "byte_rate"},
           {LinkFaultKind::kStall, "stall"},
           {LinkFaultKind::kHangUp, "hang_up"}}};
}

/// Does it only make sense with an end?
constexpr bool needs_end(LinkFaultKind kind) {
  return kind == LinkFaultKind::kStall || kind == LinkFaultKind::kHangUp;
}

/// The faults of a line in a run: those of its whole length, and those that events begin and end. A later one
/// of the same kind covers the earlier until it ends.
class RunningLinkFaults {
 public:
  using Time = std::chrono::nanoseconds;

  explicit RunningLinkFaults(const hil_bridge::transport::LinkFaultConfig& always) : always_(always) {}

  /// @param number  by which it ends, not in use by another
  /// @param link    a LinkFault or a BusFault
  /// @param until   its end, for those that need one
  template <class Link>
  void begin(std::size_t number, LinkFaultKind kind, double magnitude, Time until, Link& link) {
    if (kind == LinkFaultKind::kStall) return link.stand_still(until);
    if (kind == LinkFaultKind::kHangUp) return link.hang_up(until);
    running_[number] = {kind, magnitude};
    link.set(sum());
  }
  template <class Link>
  void end(std::size_t number, Link& link) {
    if (running_.erase(number) > 0) link.set(sum());
  }

 private:
  struct Running {
    LinkFaultKind kind;
    double magnitude;
  };

  hil_bridge::transport::LinkFaultConfig sum() const;

  hil_bridge::transport::LinkFaultConfig always_;
  std::map<std::size_t, Running> running_;
};

/// What is wrong with such a fault, or empty.
std::string_view complaint_about(LinkFaultKind kind, double magnitude);

}  // namespace ironbird::scenarios
