#include "scenarios/record/crc32.hpp"

#include <array>
#include <cstring>

namespace ironbird::scenarios {
namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320u;
constexpr std::size_t kSlices = 16;

using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

/// tables[k][b]: what byte b contributes when k more bytes follow it in the same step.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? kPolynomial : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice) {
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[slice - 1][byte];
      tables[slice][byte] = (before >> 8) ^ tables[0][before & 0xFFu];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

/// What the four bytes of `word` contribute when `following` more bytes follow the last of them.
std::uint32_t contribution(std::uint32_t word, std::size_t following) {
  return kTables[following + 3][word & 0xFFu] ^ kTables[following + 2][(word >> 8) & 0xFFu] ^
         kTables[following + 1][(word >> 16) & 0xFFu] ^ kTables[following][word >> 24];
}

/// Product of two polynomials over GF(2), modulo the CRC polynomial, in reflected bit order.
constexpr std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (std::uint32_t mask = 1u << 31; mask != 0; mask >>= 1) {
    if ((a & mask) != 0) product ^= b;
    b = (b >> 1) ^ ((b & 1u) != 0 ? kPolynomial : 0u);
  }
  return product;
}

/// kPowers[k] = x^(2^k).
constexpr std::array<std::uint32_t, 32> make_powers() {
  std::array<std::uint32_t, 32> powers{};
  powers[0] = 1u << 30;
  for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = multiply(powers[k - 1], powers[k - 1]);
  return powers;
}

constexpr std::array<std::uint32_t, 32> kPowers = make_powers();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  const std::uint8_t* next = bytes.data();
  std::size_t left = bytes.size();
  crc = ~crc;
  for (; left >= kSlices; left -= kSlices, next += kSlices) {
    std::array<std::uint32_t, 4> words;
    std::memcpy(words.data(), next, kSlices);
    crc = contribution(words[0] ^ crc, 12) ^ contribution(words[1], 8) ^ contribution(words[2], 4) ^
          contribution(words[3], 0);
  }
  for (; left > 0; --left, ++next) crc = (crc >> 8) ^ kTables[0][(crc ^ *next) & 0xFFu];
  return ~crc;
}

std::uint32_t crc32_of_both(std::uint32_t first, std::uint32_t second, std::uint64_t size_of_second) {
  // Appending n zero bytes multiplies by x^(8 n); the order of x modulo the polynomial divides 2^32 - 1, so
  // the exponents of two repeat after 32.
  std::size_t power = 3;
  for (std::uint64_t rest = size_of_second; rest != 0; rest >>= 1, ++power) {
    if ((rest & 1u) != 0) first = multiply(kPowers[power % kPowers.size()], first);
  }
  return first ^ second;
}

}  // namespace ironbird::scenarios
