#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hil_bridge/can/dronecan_transfer.hpp"
#include "hil_bridge/transport/frame_bus.hpp"

namespace ironbird::hil_bridge::can {

/// Frames that wait for the bus, the most urgent first, those of one priority in the order in which they
/// came. A transfer that is not out in time is dropped whole, so that no command goes out late. Allocates
/// nothing.
class FrameOutbox {
 public:
  static constexpr std::size_t kCapacity = 192;

  /// Cuts a transfer into frames. @return false when there is no room for all of it; then nothing is kept
  /// @param deadline  when it is too late to send it
  bool put(const TransferHead& head, std::uint16_t seed, std::span<const std::uint8_t> payload, bool fd,
           Time deadline);

  /// Gives the bus what it takes.
  void flush(Time now, transport::FrameBus& bus);

  std::size_t size() const { return size_; }
  std::uint64_t expired() const { return expired_; }  ///< frames dropped because they came too late
  std::uint64_t refused() const { return refused_; }  ///< transfers without room

 private:
  struct Waiting {
    CanFrame frame;
    Time deadline{};
  };

  void insert(const CanFrame& frame, Time deadline);

  std::array<Waiting, kCapacity> waiting_{};
  std::size_t size_ = 0;
  std::uint64_t expired_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace ironbird::hil_bridge::can
