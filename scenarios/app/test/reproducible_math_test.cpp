#include "scenarios/app/reproducible_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace ironbird::scenarios {
namespace {

constexpr double kFewUlp = 3.5 * std::numeric_limits<double>::epsilon();  // of the result: the set's promise

/// Numbers from the compiler's point of view unknown, so that it does not work out the results itself.
double hidden(double value) {
  volatile double kept = value;
  return kept;
}

void expect_near(double found, long double wanted) {
  EXPECT_LE(std::abs(static_cast<long double>(found) - wanted), kFewUlp * std::abs(wanted));
}

TEST(ReproducibleMathTest, HoldsAFewUnitsInTheLastPlace) {
  ASSERT_NE(std::strstr(reproducible_math(), "SLEEF"), nullptr);
  for (int i = 1; i < 2000; ++i) {
    const double x = hidden(-1.0 + 1e-3 * i + 1e-7);
    expect_near(std::sin(4.0 * x), sinl(4.0 * x));
    expect_near(std::cos(x), cosl(x));
    expect_near(std::asin(x), asinl(x));
    expect_near(std::atan2(x, 0.3 - x), atan2l(x, 0.3 - x));
    expect_near(std::log(1.0001 + x), logl(1.0001 + x));
  }
}

TEST(ReproducibleMathTest, IsExactWhereTheProgramReliesOnIt) {
  EXPECT_EQ(std::sin(hidden(0.0)), 0.0);
  EXPECT_EQ(std::cos(hidden(0.0)), 1.0);
  EXPECT_EQ(std::log(hidden(1.0)), 0.0);
  EXPECT_EQ(std::asin(hidden(1.0)), 0.5 * std::numbers::pi);
  EXPECT_EQ(std::asin(hidden(-1.0)), -0.5 * std::numbers::pi);
  EXPECT_EQ(std::atan2(hidden(0.0), hidden(1.0)), 0.0);
  EXPECT_EQ(std::atan2(hidden(0.0), hidden(-1.0)), std::numbers::pi);
  EXPECT_EQ(std::atan2(hidden(1.0), hidden(0.0)), 0.5 * std::numbers::pi);
}

TEST(ReproducibleMathTest, GivesOneSineWhetherItsCosineIsWantedTooOrNot) {
  for (int i = 0; i < 1000; ++i) {
    const double x = hidden(0.01 * i - 5.0);
    double sine = 0.0;
    double cosine = 0.0;
    sincos(x, &sine, &cosine);
    EXPECT_EQ(std::sin(hidden(x)), sine);
    EXPECT_EQ(std::cos(hidden(x)), cosine);
  }
}

}  // namespace
}  // namespace ironbird::scenarios
