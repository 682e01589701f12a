#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

namespace ironbird::scenarios {

static_assert(std::endian::native == std::endian::little, "logs are written as the bytes lie in memory");

/// Bytes that only ever grow at the end. Keeps its memory when cleared, so that a buffer that has seen its
/// largest content never allocates again.
class ByteBuffer {
 public:
  explicit ByteBuffer(std::size_t capacity = 0)
      : bytes_(capacity > 0 ? std::make_unique_for_overwrite<std::uint8_t[]>(capacity) : nullptr),
        capacity_(capacity) {}

  std::uint8_t* data() { return bytes_.get(); }
  const std::uint8_t* data() const { return bytes_.get(); }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::span<const std::uint8_t> bytes() const { return {bytes_.get(), size_}; }

  void clear() { size_ = 0; }

  /// Sets the size. Bytes between the old and the new size are whatever was written there through data().
  /// @param size  at most capacity()
  void set_size(std::size_t size) { size_ = size; }

  /// Makes room for `more` bytes behind the last one.
  void reserve_more(std::size_t more) {
    if (capacity_ - size_ < more) grow(more);
  }

  /// Adds `count` bytes and returns where they begin. Their content is not set.
  std::uint8_t* extend(std::size_t count) {
    reserve_more(count);
    std::uint8_t* begin = bytes_.get() + size_;
    size_ += count;
    return begin;
  }

  void append(const void* source, std::size_t count) {
    if (count > 0) std::memcpy(extend(count), source, count);
  }
  void append(std::span<const std::uint8_t> source) { append(source.data(), source.size()); }

  /// Adds a number, little-endian.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number value) { std::memcpy(extend(sizeof value), &value, sizeof value); }

  /// Overwrites a number that was added before.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put_at(std::size_t offset, Number value) { std::memcpy(bytes_.get() + offset, &value, sizeof value); }

  /// Adds a text behind its length as uint32.
  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    append(text.data(), text.size());
  }

 private:
  void grow(std::size_t more) {
    const std::size_t capacity = std::max(size_ + more, 2 * capacity_);
    auto bytes = std::make_unique_for_overwrite<std::uint8_t[]>(capacity);
    if (size_ > 0) std::memcpy(bytes.get(), bytes_.get(), size_);
    bytes_ = std::move(bytes);
    capacity_ = capacity;
  }

  std::unique_ptr<std::uint8_t[]> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace ironbird::scenarios
