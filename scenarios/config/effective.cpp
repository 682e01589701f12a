#include "scenarios/config/effective.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace ironbird::scenarios {

std::string EffectiveWriter::number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), result.ptr);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string EffectiveWriter::quoted(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7F) {
      result += "\\u00";
      result += kDigits[code >> 4];
      result += kDigits[code & 15];
    } else {
      result += c;
    }
  }
  return result + '"';
}

void EffectiveWriter::add_line(std::string_view name, const std::string& value, std::string_view unit,
                               std::string_view meaning) {
  text_.append(name).append(" = ").append(value);
  if (with_comments_) {
    text_.append("  # ");
    if (!unit.empty() && unit != "1") text_.append(unit).append("; ");
    text_.append(meaning);
  }
  text_ += '\n';
}

void EffectiveWriter::add_header(const std::string& header, std::string_view meaning) {
  if (!text_.empty()) text_ += '\n';
  text_.append(header);
  if (with_comments_) text_.append("  # ").append(meaning);
  text_ += '\n';
}

}  // namespace ironbird::scenarios
