#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/serial_fcu/connection.hpp"
#include "hil_bridge/serial_fcu/link_statistics.hpp"
#include "hil_bridge/transport/byte_stream.hpp"

namespace ironbird::hil_bridge {

/// A flight-control unit at the other end of a line: bytes to messages and back, and the talk beside the
/// flying.
///
/// The line may be down at the start and at any time after; it is tried again until it is up, and then
/// everything is found out anew. Stamps of the unit are turned into bench time where the connection
/// synchronises.
class SerialFcu final : public Fcu {
 public:
  /// @param line  outlives this
  /// @param gate  is asked before anything leaves; outlives this. Without one no motor command leaves at all,
  /// and
  ///              nothing that changes the unit
  explicit SerialFcu(transport::ByteStream& line, const ConnectionConfig& config = {}, Gate* gate = nullptr);

  /// From now on this gate is asked before anything leaves. @param gate  outlives this
  void set_gate(Gate& gate) { gate_ = &gate; }

  /// Takes what has arrived, sends what is due.
  void advance(Time now) override;
  void receive(std::vector<Arrival>& out) override;
  /// Queues one message, if the gate lets it pass; it leaves at once if the line takes it. A full queue drops
  /// it and counts.
  void send(const rosflight::Message& message) override;

  /// Hands to the line what it would not take before. @return nothing is left
  bool flush();

  Connection& connection() { return connection_; }
  const Connection& connection() const { return connection_; }
  LinkHealth health(Time now) const {
    LinkHealth health = statistics_.health(now, decoder_.counts(), connection_.time_sync().round_trip);
    health.unfetched = unfetched_;
    return health;
  }
  bool line_is_up() const { return line_.is_up(); }
  const LinkStatistics& statistics() const { return statistics_; }

  static constexpr std::uint8_t kSystem = 1;
  static constexpr std::uint8_t kComponent = 50;
  static constexpr std::uint8_t kFlashComponent =
      1;  ///< of the order to write to flash, as the usual companion

 private:
  void watch_line(Time now);
  void take(const rosflight::Frame& frame, Time now);
  rosflight::Message in_bench_time(const rosflight::Message& message, Time now);

  void write(const rosflight::Message& message);

  transport::ByteStream& line_;
  QuestionGate questions_;
  Gate* gate_;  // null: questions only
  Time now_{};
  rosflight::StreamDecoder decoder_;
  Connection connection_;
  LinkStatistics statistics_;
  std::vector<Arrival> inbox_;
  std::vector<std::uint8_t> outgoing_;
  std::uint8_t sequence_ = 0;
  std::uint64_t unfetched_ = 0;
  Time tried_ = Time::min();
  bool was_up_ = false;
};

}  // namespace ironbird::hil_bridge
