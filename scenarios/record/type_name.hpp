#pragma once

#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// The name of T as the compiler spells it, with namespaces: `ironbird::autopilot::StateEstimate`.
template <class T>
constexpr std::string_view full_type_name() {
  constexpr std::string_view text = __PRETTY_FUNCTION__;
  constexpr std::string_view key = "T = ";
  const std::size_t begin = text.find(key) + key.size();
  std::size_t depth = 0;
  std::size_t end = begin;
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (depth == 0 && (c == ';' || c == ']')) break;
    if (c == '<' || c == '[') ++depth;
    if (c == '>' || c == ']') --depth;
  }
  return text.substr(begin, end - begin);
}

/// The name without namespaces and template arguments: `StateEstimate`.
template <class T>
constexpr std::string_view short_type_name() {
  std::string_view name = full_type_name<T>();
  name = name.substr(0, name.find('<'));
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// `RateThrottle` becomes `rate_throttle`; a run of capitals is one word: `FCUCommand` becomes `fcu_command`.
std::string snake_case(std::string_view name);

/// `rate_throttle` becomes `RateThrottle`.
std::string camel_case(std::string_view name);

/// `take off` becomes `TAKE_OFF`: what is not a letter or a digit becomes an underscore.
std::string constant_case(std::string_view name);

}  // namespace ironbird::scenarios
