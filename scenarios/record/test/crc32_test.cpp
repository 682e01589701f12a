#include "scenarios/record/crc32.hpp"

#include <gtest/gtest.h>

#include "scenarios/record/test/by_hand.hpp"

namespace ironbird::scenarios {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Bytes without a pattern that a table could hide.
std::string mixed(std::size_t size) {
  std::string bytes;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < size; ++i) {
    state = 1664525u * state + 1013904223u;
    bytes += static_cast<char>(state >> 24);
  }
  return bytes;
}

TEST(Crc32Test, MatchesThePublishedCheckValue) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926u);
}

TEST(Crc32Test, OfNothingIsZero) {
  EXPECT_EQ(crc32({}), 0u);
}

TEST(Crc32Test, AgreesWithItsDefinitionAtEveryLengthAndOffset) {
  const std::string text = mixed(700);
  for (std::size_t size = 0; size + 7 < text.size(); ++size) {
    const std::string part = text.substr(size % 7, size);
    ASSERT_EQ(crc32(bytes_of(part)), by_hand::crc(part)) << size;
  }
}

TEST(Crc32Test, ContinuesWhereItStopped) {
  const std::string text = mixed(300);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    const std::uint32_t first = crc32(bytes_of(text.substr(0, cut)));
    ASSERT_EQ(crc32(bytes_of(text.substr(cut)), first), by_hand::crc(text)) << cut;
  }
}

TEST(Crc32Test, JoinsTwoRunsWithoutReadingThem) {
  for (const std::size_t size : {0, 1, 2, 63, 64, 1000, 65536, 1000000}) {
    const std::string first = mixed(77);
    const std::string second = mixed(size);
    EXPECT_EQ(crc32_of_both(crc32(bytes_of(first)), crc32(bytes_of(second)), size),
              crc32(bytes_of(first + second)))
        << size;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
