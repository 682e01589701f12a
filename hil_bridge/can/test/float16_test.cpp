#include "hil_bridge/can/float16.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ironbird::hil_bridge::can {
namespace {

/// The textbook's formula.
double meaning(unsigned half) {
  const double sign = (half & 0x8000U) != 0 ? -1.0 : 1.0;
  const int exponent = static_cast<int>(half >> 10U & 0x1FU);
  const double fraction = half & 0x3FFU;
  if (exponent == 31) return fraction == 0 ? sign * INFINITY : NAN;
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024.0 + fraction, exponent - 25);
}

TEST(Float16Test, MeansWhatTheTextbookSaysForAllPatterns) {
  for (unsigned half = 0; half <= 0xFFFF; ++half) {
    const float value = float_of(static_cast<std::uint16_t>(half));
    const double expected = meaning(half);
    if (std::isnan(expected)) {
      ASSERT_TRUE(std::isnan(value)) << half;
    } else {
      ASSERT_EQ(value, expected) << half;
      ASSERT_EQ(std::signbit(value), (half & 0x8000U) != 0) << half;
    }
  }
}

TEST(Float16Test, ComesBackFromFloatForAllPatterns) {
  for (unsigned half = 0; half <= 0xFFFF; ++half) {
    ASSERT_EQ(half_of(float_of(static_cast<std::uint16_t>(half))), half);
  }
}

TEST(Float16Test, RoundsBetweenAllNeighboursToTheNearerAndFromTheMiddleToTheEven) {
  for (unsigned low = 0; low < 0x7BFF; ++low) {
    const double middle = 0.5 * (meaning(low) + meaning(low + 1));
    const auto exact = static_cast<float>(middle);
    ASSERT_EQ(exact, middle) << "a float holds the middle exactly";
    ASSERT_EQ(half_of(exact), low + low % 2) << low;
    ASSERT_EQ(half_of(std::nextafter(exact, 0.0F)), low);
    ASSERT_EQ(half_of(std::nextafter(exact, INFINITY)), low + 1);
    ASSERT_EQ(half_of(-exact), 0x8000U + low + low % 2);
  }
}

TEST(Float16Test, ClipsWhatIsTooGreatAndKeepsInfinity) {
  EXPECT_EQ(half_of(65504.0F), 0x7BFF);
  EXPECT_EQ(half_of(65520.0F), 0x7BFF);
  EXPECT_EQ(half_of(-1e30F), 0xFBFF);
  EXPECT_EQ(half_of(INFINITY), 0x7C00);
  EXPECT_EQ(half_of(-INFINITY), 0xFC00);
}

TEST(Float16Test, KeepsANotANumberOneEvenWhenItsPayloadDoesNotFit) {
  EXPECT_EQ(half_of(std::bit_cast<float>(0x7F800001U)), 0x7E00);
  EXPECT_EQ(half_of(std::numeric_limits<float>::quiet_NaN()), 0x7E00);
}

TEST(Float16Test, LetsTheSmallestVanishWithTheirSign) {
  EXPECT_EQ(half_of(0x1.0p-26F), 0x0000);
  EXPECT_EQ(half_of(-std::numeric_limits<float>::denorm_min()), 0x8000);
}

}  // namespace
}  // namespace ironbird::hil_bridge::can
