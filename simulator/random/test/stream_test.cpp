#include "simulator/random/stream.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ironbird::simulator {
namespace {

constexpr int kDraws = 1'000'000;
constexpr double kFiveSigmaOfMean = 5.0 / 1000.0;  // sqrt(kDraws) = 1000

struct QuantileCase {
  const char* name;
  double p;
  double x;
};

class NormalQuantileTest : public ::testing::TestWithParam<QuantileCase> {};

// AS 241 promises sixteen figures; its worst relative error is a few units in the last place.
constexpr double kAlgorithmError = 1e-14;

TEST_P(NormalQuantileTest, AgreesWithTheErrorFunction) {
  const double x = normal_quantile(GetParam().p);
  EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / GetParam().p, 1.0, 40 * kAlgorithmError);
  EXPECT_NEAR(x, GetParam().x, kAlgorithmError * 10.0);
}

INSTANTIATE_TEST_SUITE_P(Cases, NormalQuantileTest,
                         ::testing::Values(QuantileCase{"Median", 0.5, 0.0},
                                           QuantileCase{"OneSigma", 0.15865525393145705, -1.0},
                                           QuantileCase{"TwoSigma", 0.022750131948179207, -2.0},
                                           QuantileCase{"SixSigma", 9.8658764503769814e-10, -6.0}),
                         [](const auto& case_) { return case_.param.name; });

TEST(StreamTest, GivesTheSameNumbersForTheSameSeedAndName) {
  Stream a(7, "sensors/gnss/white");
  Stream b(7, "sensors/gnss/white");
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(a.normal(), b.normal());
}

TEST(StreamTest, GivesUnrelatedNumbersForOtherNamesAndSeeds) {
  Stream a(7, "a"), b(7, "b"), c(8, "a");
  double ab = 0.0, ac = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = a.normal();
    ab += x * b.normal();
    ac += x * c.normal();
  }
  EXPECT_NEAR(ab / kDraws, 0.0, kFiveSigmaOfMean);
  EXPECT_NEAR(ac / kDraws, 0.0, kFiveSigmaOfMean);
}

TEST(StreamTest, HasTheMomentsOfANormalDistribution) {
  Stream stream(1, "moments");
  double m1 = 0.0, m2 = 0.0, m4 = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = stream.normal();
    m1 += x;
    m2 += x * x;
    m4 += x * x * x * x;
  }
  EXPECT_NEAR(m1 / kDraws, 0.0, kFiveSigmaOfMean);
  EXPECT_NEAR(m2 / kDraws, 1.0, kFiveSigmaOfMean * std::sqrt(2.0));
  EXPECT_NEAR(m4 / kDraws, 3.0, kFiveSigmaOfMean * std::sqrt(96.0));
}

}  // namespace
}  // namespace ironbird::simulator
