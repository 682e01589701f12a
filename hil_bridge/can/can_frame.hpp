#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace ironbird::hil_bridge::can {

/// Time since the start of the run.
using Time = std::chrono::nanoseconds;

inline constexpr std::uint32_t kGreatestIdentifier = 0x1FFFFFFF;  ///< 29 bits
inline constexpr std::uint32_t kGreatestShortIdentifier = 0x7FF;  ///< 11 bits
inline constexpr std::size_t kClassicLength = 8;                  ///< most data bytes of a classic frame
inline constexpr std::size_t kFdLength = 64;                      ///< most data bytes of a CAN FD frame

/// One frame of a CAN bus, classic or FD.
struct CanFrame {
  std::uint32_t identifier = 0;
  bool extended = true;
  bool remote = false;
  bool fd = false;
  bool bit_rate_switch = false;
  bool error = false;
  std::uint8_t size = 0;
  std::array<std::uint8_t, kFdLength> data{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("identifier", self.identifier, "1",
          "29 or 11 bits, lower is more urgent; of an error frame its classes");
    visit("extended", self.extended, "1", "the identifier has 29 bits");
    visit("remote", self.remote, "1", "asks for a frame instead of being one");
    visit("fd", self.fd, "1", "CAN FD");
    visit("bit_rate_switch", self.bit_rate_switch, "1", "CAN FD data at the faster bit rate");
    visit("error", self.error, "1", "never was on the bus: the controller reports a fault");
    visit("size", self.size, "byte", "length of the data");
    visit("data", self.data, "1", "the first `size` bytes count");
  }

  friend constexpr bool operator==(const CanFrame& a, const CanFrame& b) {
    return a.identifier == b.identifier && a.extended == b.extended && a.remote == b.remote && a.fd == b.fd &&
           a.bit_rate_switch == b.bit_rate_switch && a.error == b.error && a.size == b.size &&
           std::equal(a.data.begin(), a.data.begin() + a.size, b.data.begin());
  }
};

/// A frame that arrived.
struct ReceivedFrame {
  CanFrame frame;
  Time stamp{};

  template <class Self, class Visit>
  static constexpr void describe(Self& self, Visit&& visit) {
    visit("frame", self.frame, "", "what arrived");
    visit("stamp", self.stamp, "ns", "when it was whole");
  }
};

/// The smallest length that a frame can have which holds `bytes`, at most 64: CAN FD knows only some.
constexpr std::size_t fd_length(std::size_t bytes) {
  constexpr std::array<std::size_t, 7> kLengths = {12, 16, 20, 24, 32, 48, 64};
  if (bytes <= kClassicLength) return bytes;
  return *std::find_if(kLengths.begin(), kLengths.end() - 1,
                       [&](std::size_t length) { return length >= bytes; });
}

/// Can a bus carry this frame?
constexpr bool is_sendable(const CanFrame& frame) {
  if (frame.error || (frame.remote && frame.fd) || (frame.bit_rate_switch && !frame.fd)) return false;
  if (frame.identifier > (frame.extended ? kGreatestIdentifier : kGreatestShortIdentifier)) return false;
  return frame.fd ? frame.size <= kFdLength && fd_length(frame.size) == frame.size
                  : frame.size <= kClassicLength;
}

}  // namespace ironbird::hil_bridge::can
