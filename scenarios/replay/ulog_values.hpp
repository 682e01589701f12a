#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenarios/replay/ulog_file.hpp"

// Values as they stand in the messages of a ULog file.

namespace ironbird::scenarios {

/// A number at `offset`, little endian. The bytes must reach that far.
template <class T>
T ulog_value(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::string_view ulog_text(std::span<const std::uint8_t> bytes);

/// `type name` and the bytes of the value behind it.
struct UlogKeyed {
  UlogFormatField key;
  std::span<const std::uint8_t> value;
};

/// Takes an information, a parameter and the like apart. @return nothing when it is none
std::optional<UlogKeyed> ulog_keyed(std::span<const std::uint8_t> content);

/// The value as text, whatever its type; of an array of numbers the first. @return nothing when it has
/// another length than its type says
std::optional<std::string> ulog_value_text(const UlogKeyed& found);

/// @return nothing when it is neither a whole number of 32 bits nor a float
std::optional<UlogNumber> ulog_parameter(const UlogKeyed& found);

}  // namespace ironbird::scenarios
