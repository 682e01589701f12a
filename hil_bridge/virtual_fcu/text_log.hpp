#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace ironbird::hil_bridge::virtual_fcu {

/// Severities that the firmware uses; the values are those of the wire.
enum class Severity : std::uint8_t { kCritical = 2, kError = 3, kWarning = 4, kInfo = 6 };

/// Where parts of the firmware write lines for the operator.
class TextLog {
 public:
  virtual ~TextLog() = default;
  /// @param text  at most 49 characters are kept
  virtual void write(Severity severity, std::string_view text) = 0;
};

/// A line put together without memory from the heap. What does not fit is dropped.
class TextLine {
 public:
  explicit TextLine(std::string_view text) { add(text); }

  TextLine& add(std::string_view text) {
    const std::size_t count = std::min(text.size(), buffer_.size() - size_);
    std::copy_n(text.begin(), count, buffer_.begin() + size_);
    size_ += count;
    return *this;
  }
  TextLine& add(int number) {
    take(std::to_chars(buffer_.data() + size_, buffer_.data() + buffer_.size(), number));
    return *this;
  }
  /// With two digits after the point.
  TextLine& add(float number) {
    take(std::to_chars(buffer_.data() + size_, buffer_.data() + buffer_.size(), number,
                       std::chars_format::fixed, 2));
    return *this;
  }

  std::string_view text() const { return {buffer_.data(), size_}; }

 private:
  void take(std::to_chars_result result) {
    if (result.ec == std::errc()) size_ = static_cast<std::size_t>(result.ptr - buffer_.data());
  }

  std::array<char, 49> buffer_{};
  std::size_t size_ = 0;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
