#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// SHA-256 (FIPS 180-4) of the bytes.
std::array<std::uint8_t, 32> sha256(std::span<const std::uint8_t> bytes);

/// SHA-256 of a text as 64 hexadecimal digits.
std::string digest(std::string_view text);

}  // namespace ironbird::scenarios
