#include "hil_bridge/serial_fcu/parameter_set.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <system_error>

namespace ironbird::hil_bridge {

namespace {

constexpr std::string_view kNan = "nan(0x";

/// All of `text` as a number.
template <class T>
std::optional<T> whole(std::string_view text, int base = 10) {
  T value{};
  const char* const end = text.data() + text.size();
  std::from_chars_result result{};
  if constexpr (std::is_floating_point_v<T>) {
    result = std::from_chars(text.data(), end, value);
  } else {
    result = std::from_chars(text.data(), end, value, base);
  }
  return result.ec == std::errc() && result.ptr == end ? std::optional(value) : std::nullopt;
}

template <class T, class... Base>
std::string text_of(T value, Base... base) {
  std::array<char, 32> letters{};
  const auto result = std::to_chars(letters.data(), letters.data() + letters.size(), value, base...);
  return {letters.data(), result.ptr};
}

}  // namespace

std::string value_text(const ParameterRecord& record) {
  if (record.type == kIntegerParameter) return text_of(std::bit_cast<std::int32_t>(record.bits));
  const auto value = std::bit_cast<float>(record.bits);
  if (std::isnan(value)) return std::string(kNan) + text_of(record.bits, 16) + ")";
  return text_of(value);  // the shortest text that reads back to the same float
}

std::optional<std::uint32_t> value_bits(std::uint8_t type, std::string_view text) {
  if (type == kIntegerParameter) {
    const auto value = whole<std::int32_t>(text);
    return value ? std::optional(std::bit_cast<std::uint32_t>(*value)) : std::nullopt;
  }
  if (type != kRealParameter) return std::nullopt;
  if (text.starts_with(kNan) && text.ends_with(')')) {
    return whole<std::uint32_t>(text.substr(kNan.size(), text.size() - kNan.size() - 1), 16);
  }
  const auto value = whole<float>(text);
  return value ? std::optional(std::bit_cast<std::uint32_t>(*value)) : std::nullopt;
}

std::vector<ParameterDifference> differences(const std::vector<ParameterRecord>& one,
                                             const std::vector<ParameterRecord>& other) {
  std::map<std::string, const ParameterRecord*> rest;
  for (const ParameterRecord& record : other) rest.emplace(record.name, &record);
  std::vector<ParameterDifference> found;
  for (const ParameterRecord& record : one) {
    const auto twin = rest.find(record.name);
    if (twin == rest.end()) {
      found.push_back({record.name, record, std::nullopt});
    } else {
      if (*twin->second != record) found.push_back({record.name, record, *twin->second});
      rest.erase(twin);
    }
  }
  for (const ParameterRecord& record : other) {
    if (rest.contains(record.name)) found.push_back({record.name, std::nullopt, record});
  }
  return found;
}

std::vector<ParameterDifference> not_as_wanted(const std::vector<ParameterRecord>& wanted,
                                               const std::vector<ParameterRecord>& told) {
  std::vector<ParameterDifference> found = differences(wanted, told);
  std::erase_if(found, [](const ParameterDifference& difference) { return !difference.one; });
  return found;
}

}  // namespace ironbird::hil_bridge
