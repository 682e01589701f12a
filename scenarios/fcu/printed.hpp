#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace ironbird::scenarios {

/// One number, or several, as text.
template <class... Value>
std::string printed(const char* format, Value... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace ironbird::scenarios
