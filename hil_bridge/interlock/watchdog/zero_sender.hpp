#pragma once

#include <cstddef>
#include <cstdint>

#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"
#include "hil_bridge/transport/file_descriptor.hpp"

namespace ironbird::hil_bridge {

/// All that a watchdog can do to a line: send zero thrust, and hear whether the unit is disarmed. It has no
/// other words.
class ZeroSender {
 public:
  void take_line(transport::FileDescriptor line);
  bool has_line() const { return static_cast<bool>(line_); }
  /// Closes a line that the other side has left: held open, it would keep its device from coming back under
  /// the same name, and zeros into it reach nobody.
  void drop_if_dead();

  /// Throws away what the bench had queued and what was said to it; neither is true any more.
  void discard_old();
  /// Sends one zero command, or the rest of the last one. @return did the line take something?
  bool send_zero();
  /// Reads what has come. @return did the unit say that it is disarmed?
  bool heard_disarmed();

 private:
  transport::FileDescriptor line_;
  rosflight::StreamDecoder decoder_;
  rosflight::FrameBytes frame_;
  std::size_t sent_ = 0;  // bytes of `frame_`
  std::uint8_t sequence_ = 0;
};

}  // namespace ironbird::hil_bridge
