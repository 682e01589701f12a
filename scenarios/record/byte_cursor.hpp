#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>

namespace ironbird::scenarios {

/// Reads little-endian numbers and texts from front to back. Never reads beyond the end: it throws
/// std::out_of_range instead.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> Number get() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  /// A text behind its length as uint32.
  std::string_view text() {
    const auto bytes = take(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  std::span<const std::uint8_t> take(std::uint64_t count) {
    if (count > rest_.size()) throw std::out_of_range("ends too early");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::span<const std::uint8_t> rest_;
};

}  // namespace ironbird::scenarios
