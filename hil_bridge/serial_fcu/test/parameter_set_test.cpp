#include "hil_bridge/serial_fcu/parameter_set.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

namespace ironbird::hil_bridge {
namespace {

TEST(ParameterSetTest, ReadsEveryValueBackToTheSameBits) {
  std::mt19937 random(1);
  for (int k = 0; k < 200'000; ++k) {
    const std::uint32_t bits = random();
    for (const std::uint8_t type : {kIntegerParameter, kRealParameter}) {
      const std::string text = value_text({"A", type, bits});
      const auto back = value_bits(type, text);
      ASSERT_TRUE(back) << text;
      ASSERT_EQ(*back, bits) << text;
    }
  }
}

TEST(ParameterSetTest, WritesValuesAsPeopleDo) {
  EXPECT_EQ(value_text({"A", kIntegerParameter, 0xFFFFFFFFU}), "-1");
  EXPECT_EQ(value_text({"A", kRealParameter, std::bit_cast<std::uint32_t>(0.075F)}), "0.075");
  EXPECT_EQ(value_text({"A", kRealParameter, 0xFFFFFFFFU}), "nan(0xffffffff)");
  EXPECT_EQ(value_text({"A", kRealParameter, std::bit_cast<std::uint32_t>(-INFINITY)}), "-inf");
}

TEST(ParameterSetTest, RefusesWhatIsNoValueOfTheType) {
  for (const char* text : {"", "4.5", "four", "4 ", "99999999999", "0x10"}) {
    EXPECT_FALSE(value_bits(kIntegerParameter, text)) << text;
  }
  for (const char* text : {"", "0.5V", "nan(0x)", "nan(0xzz)", "nan(0x1"}) {
    EXPECT_FALSE(value_bits(kRealParameter, text)) << text;
  }
  EXPECT_FALSE(value_bits(2, "1"));
}

TEST(ParameterSetTest, TellsWhereTwoSetsDiffer) {
  const std::vector<ParameterRecord> one = {{"A", 6, 1}, {"B", 6, 2}, {"C", 6, 3}};
  const std::vector<ParameterRecord> other = {{"B", 6, 2}, {"A", 6, 9}, {"D", 9, 4}};
  const auto found = differences(one, other);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "A");
  EXPECT_EQ(found[0].other->bits, 9U);
  EXPECT_EQ(found[1].name, "C");
  EXPECT_FALSE(found[1].other);
  EXPECT_EQ(found[2].name, "D");
  EXPECT_FALSE(found[2].one);
  EXPECT_TRUE(differences(one, one).empty());
}

}  // namespace
}  // namespace ironbird::hil_bridge
