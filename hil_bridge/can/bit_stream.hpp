#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

// Numbers of any width one behind the other, without alignment, in the order of DroneCAN: the bytes of a
// number from the least significant one, each byte from its highest bit; what is left above the last full
// byte goes last.

namespace ironbird::hil_bridge::can {

/// Writes numbers into bytes, which have to be large enough.
class BitWriter {
 public:
  explicit BitWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {
    std::fill(bytes.begin(), bytes.end(), 0);
  }

  /// @param width  bits, 0 to 64; higher ones of the value are ignored
  constexpr void put(std::uint64_t value, unsigned width) {
    for (; width >= 8; width -= 8, value >>= 8U) put_piece(static_cast<unsigned>(value & 0xFFU), 8);
    put_piece(static_cast<unsigned>(value & ((1U << width) - 1U)), width);
  }

  /// Bytes that hold something.
  std::size_t size() const { return (place_ + 7) / 8; }

 private:
  constexpr void put_piece(unsigned value, unsigned width) {
    if (width == 0) return;
    const std::size_t byte = place_ / 8;
    const auto used = static_cast<unsigned>(place_ % 8);
    const unsigned aligned = value << (16U - width) >> used;
    bytes_[byte] = static_cast<std::uint8_t>(bytes_[byte] | aligned >> 8U);
    if (used + width > 8) bytes_[byte + 1] = static_cast<std::uint8_t>(aligned & 0xFFU);
    place_ += width;
  }

  std::span<std::uint8_t> bytes_;
  std::size_t place_ = 0;
};

/// Reads what BitWriter writes. Behind the end there are zeros, and `overrun`.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// @param width  bits, 0 to 64
  constexpr std::uint64_t take(unsigned width) {
    std::uint64_t value = 0;
    unsigned done = 0;
    for (; width - done >= 8; done += 8) value |= static_cast<std::uint64_t>(take_piece(8)) << done;
    return done < width ? value | static_cast<std::uint64_t>(take_piece(width - done)) << done : value;
  }

  std::size_t left() const { return overrun_ ? 0 : bytes_.size() * 8 - place_; }  ///< bits
  bool overrun() const { return overrun_; }

 private:
  constexpr unsigned take_piece(unsigned width) {
    if (place_ + width > bytes_.size() * 8) {
      overrun_ = true;
      return 0;
    }
    const std::size_t byte = place_ / 8;
    const auto used = static_cast<unsigned>(place_ % 8);
    const unsigned next = used + width > 8 ? bytes_[byte + 1] : 0U;
    const unsigned both = (static_cast<unsigned>(bytes_[byte]) << 8U | next) << used & 0xFFFFU;
    place_ += width;
    return both >> (16U - width);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t place_ = 0;
  bool overrun_ = false;
};

}  // namespace ironbird::hil_bridge::can
