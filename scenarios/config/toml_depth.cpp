#include "scenarios/config/toml_depth.hpp"

#include <algorithm>
#include <string>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/include.hpp"

namespace ironbird::scenarios {
namespace {

bool is_part_of_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == ' ' || c == '\t' || static_cast<unsigned char>(c) >= 0x80;
}

/// Where the text in quotes that begins at `begin` ends. Of a text that does not end, the end of its line.
std::size_t end_of_quoted(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const bool escapes = quote == '"';
  const std::string three(3, quote);
  const bool in_lines = text.substr(begin, 3) == three;
  for (std::size_t at = begin + (in_lines ? 3 : 1); at < text.size(); ++at) {
    if (escapes && text[at] == '\\') {
      ++at;
    } else if (in_lines && text.substr(at, 3) == three) {
      at += 3;  // up to two more belong to the text
      for (int more = 0; more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;
    } else if (!in_lines && (text[at] == quote || text[at] == '\n')) {
      return at + 1;
    }
  }
  return text.size();
}

/// `name:line:column`, columns in characters of UTF-8.
std::string place_in(std::string_view text, std::size_t at, std::string_view name) {
  const std::string_view before = text.substr(0, at);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string_view own = before.substr(before.rfind('\n') + 1);
  const auto column = 1 + std::count_if(own.begin(), own.end(), [](char c) { return (c & 0xC0) != 0x80; });
  return std::string(name) + ":" + std::to_string(line) + ":" + std::to_string(column);
}

}  // namespace

std::string too_deep() {
  return ": more than " + std::to_string(kDeepestToml) + " tables lie in one another";
}

void refuse_long_keys(std::string_view text, std::string_view name) {
  std::size_t dots = 0;
  std::size_t first_dot = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '"' || c == '\'') {
      at = end_of_quoted(text, at);
    } else {
      if (c == '.' && dots == 0) first_dot = at;
      dots = c == '.' ? dots + 1 : is_part_of_key(c) ? dots : 0;
      if (dots >= kDeepestToml) throw ConfigError(place_in(text, first_dot, name) + too_deep());
      ++at;
    }
  }
}

void refuse_depth(const toml::node& node, std::size_t depth) {
  if (depth > kDeepestToml) throw ConfigError(place_of(node) + too_deep());
  if (const toml::table* const table = node.as_table()) {
    for (const auto& [key, value] : *table) refuse_depth(value, depth + 1);
  } else if (const toml::array* const array = node.as_array()) {
    for (const toml::node& value : *array) refuse_depth(value, depth + 1);
  }
}

}  // namespace ironbird::scenarios
