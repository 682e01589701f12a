#pragma once

#include <cstdint>
#include <optional>

#include "hil_bridge/transport/bounded_queue.hpp"
#include "hil_bridge/transport/faulty_direction.hpp"
#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::transport {

/// One end of a CAN bus that loses, delays, spoils and cuts, around any other: what LinkFault is for lines.
///
/// A piece is a frame. A real controller finds spoilt frames by their checksum; here they come through, for
/// the receiver to be tried, unless no bus could carry them. Noise becomes a frame that nobody sent. Cut, the
/// interface is down, and up again by itself when its time is over.
class BusFault final : public FrameBus {
 public:
  /// @param bus  outlives this
  BusFault(FrameBus& bus, const LinkFaultConfig& config, std::uint64_t seed);

  /// What is due by `now` goes out, and what has come in is taken. Stamps are those of coming out here.
  void advance(Time now);

  /// Other faults from now on. @throws std::invalid_argument naming key, value and bound
  void set(const LinkFaultConfig& config);
  /// Nothing goes either way until then; nothing is lost.
  void stand_still(Time until);
  /// The interface is down until then.
  void hang_up(Time until);

  bool send(const CanFrame& frame) override;
  std::optional<ReceivedFrame> receive() override;
  std::optional<BusEvent> take_event() override;
  void set_filters(std::span<const FrameFilter> filters) override { bus_.set_filters(filters); }
  BusState state() const override { return up_ ? bus_.state() : BusState::kDown; }
  bool fd() const override { return bus_.fd(); }
  const BusCounters& counters() const override { return bus_.counters(); }

  const FaultCounts& outgoing() const { return outgoing_.counts(); }
  const FaultCounts& incoming() const { return incoming_.counts(); }

 private:
  void send_due();
  void cut(Time closed_for);
  std::optional<CanFrame> frame_of(const FaultyDirection::Due& piece) const;

  FrameBus& bus_;
  FaultyDirection outgoing_;
  FaultyDirection incoming_;
  BoundedQueue<BusEvent> events_;
  Time now_{};
  Time closed_until_{};
  bool up_ = true;
};

}  // namespace ironbird::hil_bridge::transport
