#pragma once

#include <cstdint>
#include <span>

namespace ironbird::scenarios {

/// CRC-32 as in zip, PNG and MCAP: reflected polynomial 0xEDB88320, initial value and final inversion all
/// ones.
/// @param crc  result for the bytes before these; 0 to begin
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

/// The CRC-32 of two runs of bytes, one behind the other, from the CRC-32 of each.
/// @param size_of_second  length of the second run, bytes
std::uint32_t crc32_of_both(std::uint32_t first, std::uint32_t second, std::uint64_t size_of_second);

}  // namespace ironbird::scenarios
