#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace ironbird::hil_bridge::transport {

/// A line that cannot be opened, or not be used: what, where, and what to do. Ends a program with exit
/// code 3.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Room with which a read loses nothing of a datagram.
inline constexpr std::size_t kReadRoom = 65536;

/// A line for bytes in both directions, which may be cut at any time and come back.
///
/// Nothing here waits: the caller decides when to look again. Whoever waits for several lines does so with
/// their descriptors.
class ByteStream {
 public:
  virtual ~ByteStream() = default;

  /// Takes what has arrived, as much as there is room for. @return how many bytes, 0 when there are none or
  /// the line is cut
  virtual std::size_t read(std::span<std::uint8_t> to) = 0;

  /// Hands bytes to the line. @return how many it took: fewer when its queue is full, 0 when it is cut
  virtual std::size_t write(std::span<const std::uint8_t> from) = 0;

  /// Is the line up? It goes down when the other side hangs up, or the plug is pulled.
  virtual bool is_up() const = 0;

  /// Tries to bring a line that is down up again. @return is it up now?
  virtual bool reopen() = 0;

  /// What to wait for with poll(2), or -1.
  virtual int descriptor() const { return -1; }

  /// How a message names it: "/dev/ttyACM0 at 921600 Bd".
  virtual std::string name() const = 0;
};

}  // namespace ironbird::hil_bridge::transport
