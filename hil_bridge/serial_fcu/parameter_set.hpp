#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/rosflight/vocabulary.hpp"

namespace ironbird::hil_bridge {

/// One parameter as its 32 bits and what they mean. The bits are never computed with: those of an integer may
/// be a NaN's.
struct ParameterRecord {
  std::string name;
  std::uint8_t type = 0;
  std::uint32_t bits = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "up to 16 letters");
    visit("type", self.type, "1", "6 int32, 9 float32");
    visit("bits", self.bits, "1", "bits of the value");
  }

  bool operator==(const ParameterRecord&) const = default;
};

inline constexpr auto kIntegerParameter = static_cast<std::uint8_t>(rosflight::ParameterType::kInteger);
inline constexpr auto kRealParameter = static_cast<std::uint8_t>(rosflight::ParameterType::kReal);

/// The value as text that reads back to the same bits: "4", "0.075", "nan(0x7fa12345)".
std::string value_text(const ParameterRecord& record);
/// The bits of a value written as text, or none when `text` is not a value of that type.
std::optional<std::uint32_t> value_bits(std::uint8_t type, std::string_view text);
/// What a text must be to be such a value, for a message.
inline std::string_view demand_on_value(std::uint8_t type) {
  return type == kIntegerParameter ? "must be a whole number of 32 bits" : "must be a real number";
}

/// Where two sets differ.
struct ParameterDifference {
  std::string name;
  std::optional<ParameterRecord> one;
  std::optional<ParameterRecord> other;
};

/// By name, in the order of `one`, then what only `other` has. Values are equal when type and bits are.
std::vector<ParameterDifference> differences(const std::vector<ParameterRecord>& one,
                                             const std::vector<ParameterRecord>& other);

/// Of the wanted ones those that `told` has otherwise, or not at all.
std::vector<ParameterDifference> not_as_wanted(const std::vector<ParameterRecord>& wanted,
                                               const std::vector<ParameterRecord>& told);

}  // namespace ironbird::hil_bridge
