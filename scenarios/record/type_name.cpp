#include "scenarios/record/type_name.hpp"

namespace ironbird::scenarios {
namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
char to_lower(char c) {
  return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}
char to_upper(char c) {
  return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
}

}  // namespace

std::string snake_case(std::string_view name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool after_word = i > 0 && (is_lower(name[i - 1]) || is_digit(name[i - 1]));
    const bool last_of_run = i > 0 && i + 1 < name.size() && is_upper(name[i - 1]) && is_lower(name[i + 1]);
    if (is_upper(name[i]) && (after_word || last_of_run)) result += '_';
    result += to_lower(name[i]);
  }
  return result;
}

std::string camel_case(std::string_view name) {
  std::string result;
  bool starts_word = true;
  for (const char c : name) {
    if (!is_upper(c) && !is_lower(c) && !is_digit(c)) {
      starts_word = true;
      continue;
    }
    result += starts_word ? to_upper(c) : c;
    starts_word = false;
  }
  return result;
}

std::string constant_case(std::string_view name) {
  std::string result;
  for (const char c : name) {
    result += is_upper(c) || is_lower(c) || is_digit(c) ? to_upper(c) : '_';
  }
  return result;
}

}  // namespace ironbird::scenarios
