#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "hil_bridge/can/node_messages.hpp"

// How a node without a number gets one: it tells its unique id in three parts, anonymously, and is granted a
// number when the other side has all of it. Both sides are pure: messages in, messages out.

namespace ironbird::hil_bridge::can {

using UniqueId = std::array<std::uint8_t, 16>;

/// The side that wants a number. Waits are random within the bounds of the definition, from its own unique
/// id, so that two nodes that begin together part soon, and the same run gives the same frames.
class NodeIdClient {
 public:
  /// @param wish  the number that it would like, 0 for any
  NodeIdClient(const UniqueId& unique_id, std::uint8_t wish, Time now);

  /// The anonymous message that is due, if any.
  std::optional<Allocation> step(Time now);

  /// Every Allocation message on the bus is handed in.
  /// @param anonymous  it came from a node without a number
  void take(const Allocation& message, bool anonymous, Time now);

  /// The number that was granted.
  std::optional<std::uint8_t> node() const { return node_; }

 private:
  void start_over(Time now);
  double chance();

  UniqueId unique_id_;
  std::uint64_t dice_;
  std::optional<std::uint8_t> node_;
  Time due_{};
  std::size_t told_ = 0;
  std::uint8_t wish_;
};

/// The side that gives numbers, and remembers whom it gave which.
class NodeIdServer {
 public:
  /// A part is forgotten when the next one does not follow within this.
  static constexpr Time kFollowUp = std::chrono::milliseconds(500);
  static constexpr std::uint8_t kGreatestGrant = 125;  ///< the two above are for tools

  /// @param taken  is a number in use on the bus by somebody who was not given it here?
  /// @return the answer, if any
  std::optional<Allocation> take(const Allocation& wish, Time now,
                                 const std::function<bool(std::uint8_t)>& taken);

  /// Whom a number was given to.
  const std::optional<UniqueId>& owner(std::uint8_t node) const { return owners_[node & 0x7FU]; }

 private:
  std::optional<std::uint8_t> grant(const std::function<bool(std::uint8_t)>& taken);

  std::array<std::optional<UniqueId>, kGreatestNode + 1> owners_{};
  UniqueId heard_{};
  std::size_t count_ = 0;
  std::uint8_t wish_ = 0;
  Time last_{};
};

}  // namespace ironbird::hil_bridge::can
