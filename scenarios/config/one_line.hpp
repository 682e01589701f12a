#pragma once

#include <string>

namespace ironbird::scenarios {

/// A message quotes what it found. Whatever that was, it neither breaks the line nor talks to the terminal.
inline std::string on_one_line(std::string text) {
  constexpr std::size_t kLongest = 1000;
  if (text.size() > kLongest) {
    text.resize(kLongest);
    text += "...";
  }
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return text;
}

}  // namespace ironbird::scenarios
