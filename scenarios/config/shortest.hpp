#pragma once

#include <array>
#include <charconv>
#include <string>

namespace ironbird::scenarios {

/// The number with the fewest digits that read back to it: `-3.9`, `1e-06`.
inline std::string shortest(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace ironbird::scenarios
