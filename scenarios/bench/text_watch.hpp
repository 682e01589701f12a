#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string_view>

namespace ironbird::scenarios {

/// Tells the news among the texts of an FCU from what it repeats: some are sent in every step for as long as
/// their reason lasts. Texts that differ in their numbers only are the same text.
class TextWatch {
 public:
  using Time = std::chrono::nanoseconds;

  /// @return whether `text` was not heard in the ten seconds before
  bool is_news(std::string_view text, Time now);

 private:
  /// A text without its numbers, cut to the length that the wire has.
  struct Heard {
    std::array<char, 50> words{};
    std::size_t length = 0;
    Time last{};
    std::string_view view() const { return {words.data(), length}; }
  };

  std::array<Heard, 32> heard_{};
  std::size_t count_ = 0;
};

}  // namespace ironbird::scenarios
