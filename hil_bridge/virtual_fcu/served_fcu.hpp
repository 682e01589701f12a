#pragma once

#include <cstdint>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/rosflight/firmware_decoder.hpp"
#include "hil_bridge/transport/byte_stream.hpp"

namespace ironbird::hil_bridge {

/// Puts a unit on a line: what a companion that knows nothing of this program hears and says, as the firmware
/// would: sequence numbers, system numbers and their oddities included.
class ServedFcu {
 public:
  /// @param unit  whose time is let pass by somebody else; outlives this
  /// @param line  outlives this
  /// @param system  its SYS_ID at the start
  ServedFcu(Fcu& unit, transport::ByteStream& line, std::uint8_t system = 1);

  /// Hands the unit what has come over the line.
  void take();
  /// Hands the line what the unit has said. A queue of packets that is full drops new ones silently, as
  /// boards do.
  void give();

  /// Has the line taken all that the unit said?
  bool all_given() const { return outgoing_.empty(); }
  /// Frames that came over the line.
  std::uint64_t frames_taken() const { return frames_taken_; }
  /// Bytes read from and written to the line.
  std::uint64_t bytes_taken() const { return bytes_taken_; }
  std::uint64_t bytes_given() const { return bytes_given_; }
  /// Packets dropped because the line took no more.
  std::uint64_t dropped() const { return dropped_; }

 private:
  rosflight::Address sender_of(const Arrival& arrival) const;

  Fcu& unit_;
  transport::ByteStream& line_;
  rosflight::FirmwareDecoder decoder_;
  std::vector<Arrival> said_;
  std::vector<std::uint8_t> outgoing_;
  std::uint8_t sequence_ = 0;
  std::uint8_t system_;
  std::uint8_t requester_ = 1;
  std::uint64_t frames_taken_ = 0;
  std::uint64_t bytes_taken_ = 0;
  std::uint64_t bytes_given_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace ironbird::hil_bridge
