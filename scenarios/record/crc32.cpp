#include "scenarios/record/crc32.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

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

/// Takes the bytes into the register by tables.
std::uint32_t take_by_tables(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  const std::uint8_t* next = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= kSlices; left -= kSlices, next += kSlices) {
    std::array<std::uint32_t, 4> words;
    std::memcpy(words.data(), next, kSlices);
    crc = contribution(words[0] ^ crc, 12) ^ contribution(words[1], 8) ^ contribution(words[2], 4) ^
          contribution(words[3], 0);
  }
  for (; left > 0; --left, ++next) crc = (crc >> 8) ^ kTables[0][(crc ^ *next) & 0xFFu];
  return crc;
}

#if defined(__x86_64__)

/// Bytes that the carry-less multiplication takes at once.
constexpr std::size_t kFold = 64;

/// What moves 64 bits of the message `bits` further: x^bits modulo the polynomial, in the bit order of the
/// multiplication, which gives products one place too low.
constexpr std::int64_t fold_factor(std::uint32_t bits) {
  std::uint32_t power = 1u << 31;
  for (std::uint32_t i = 0; i < bits; ++i) power = (power >> 1) ^ ((power & 1u) != 0 ? kPolynomial : 0u);
  return static_cast<std::int64_t>(std::uint64_t{power} << 1);
}

/// Moves the 128 bits of `state` on to where `next` lies and adds them there.
__attribute__((target("pclmul,sse4.1"))) inline __m128i fold(__m128i state, __m128i factors, __m128i next) {
  const __m128i low = _mm_clmulepi64_si128(state, factors, 0x00);
  const __m128i high = _mm_clmulepi64_si128(state, factors, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

__attribute__((target("pclmul,sse4.1"))) inline __m128i load(const std::uint8_t* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}

/// Takes the bytes into the register by carry-less multiplication: four strands of 128 bits are moved on over
/// the message and what is left of them goes through the tables.
/// @param bytes  at least kFold of them
__attribute__((target("pclmul,sse4.1"))) std::uint32_t take_by_folding(std::span<const std::uint8_t> bytes,
                                                                       std::uint32_t crc) {
  constexpr std::array<std::int64_t, 2> kBy512{fold_factor(512 + 32), fold_factor(512 - 32)};
  constexpr std::array<std::int64_t, 2> kBy128{fold_factor(128 + 32), fold_factor(128 - 32)};
  const __m128i by_512 = _mm_set_epi64x(kBy512[1], kBy512[0]);
  const __m128i by_128 = _mm_set_epi64x(kBy128[1], kBy128[0]);
  const std::uint8_t* next = bytes.data();
  const std::uint8_t* end = next + bytes.size();
  __m128i a = _mm_xor_si128(load(next), _mm_cvtsi32_si128(static_cast<int>(crc)));
  __m128i b = load(next + 16);
  __m128i c = load(next + 32);
  __m128i d = load(next + 48);
  for (next += kFold; static_cast<std::size_t>(end - next) >= kFold; next += kFold) {
    a = fold(a, by_512, load(next));
    b = fold(b, by_512, load(next + 16));
    c = fold(c, by_512, load(next + 32));
    d = fold(d, by_512, load(next + 48));
  }
  a = fold(fold(fold(a, by_128, b), by_128, c), by_128, d);
  std::array<std::uint8_t, 16> left;
  std::memcpy(left.data(), &a, left.size());
  return take_by_tables({next, static_cast<std::size_t>(end - next)}, take_by_tables(left, 0));
}

std::uint32_t take(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  const bool can_fold = __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("sse4.1") != 0;
  return can_fold && bytes.size() >= kFold ? take_by_folding(bytes, crc) : take_by_tables(bytes, crc);
}

#else

std::uint32_t take(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  return take_by_tables(bytes, crc);
}

#endif

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  return ~take(bytes, ~crc);
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
