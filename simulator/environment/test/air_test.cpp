#include "simulator/environment/air.hpp"

#include <gtest/gtest.h>

namespace ironbird::simulator {
namespace {

struct AltitudeCase {
  const char* name;
  double altitude;     // m, geometric
  double temperature;  // K
  double pressure;     // Pa
  double density;      // kg/m^3
};

class StandardAtmosphereTest : public ::testing::TestWithParam<AltitudeCase> {};

// U.S. Standard Atmosphere 1976, table I: five figures.
constexpr double kLastFigure = 5e-5;

TEST_P(StandardAtmosphereTest, AgreesWithThePublishedTable) {
  const AltitudeCase& row = GetParam();
  const Air air(AirParams{}, 400.0);
  const double height = row.altitude - 400.0;
  EXPECT_NEAR(air.temperature(height) / row.temperature, 1.0, kLastFigure);
  EXPECT_NEAR(air.pressure(height) / row.pressure, 1.0, kLastFigure);
  EXPECT_NEAR(air.density(height) / row.density, 1.0, kLastFigure);
}

INSTANTIATE_TEST_SUITE_P(Altitudes, StandardAtmosphereTest,
                         ::testing::Values(AltitudeCase{"SeaLevel", 0.0, 288.150, 101325.0, 1.2250},
                                           AltitudeCase{"m1000", 1000.0, 281.651, 89876.0, 1.1117},
                                           AltitudeCase{"m2000", 2000.0, 275.154, 79501.0, 1.0066},
                                           AltitudeCase{"m5000", 5000.0, 255.676, 54048.0, 0.73643},
                                           AltitudeCase{"m10000", 10000.0, 223.252, 26500.0, 0.41351}),
                         [](const auto& case_) { return case_.param.name; });

TEST(AirTest, HasTheGradientOfItsDensity) {
  const Air air(AirParams{}, 1387.0);
  constexpr double kHalf = 1.0;          // m
  constexpr double kDifference = 1e-11;  // kg/m^4, of 1e-4: third derivative of the density, rounding
  for (const double height : {-50.0, 0.0, 120.0, 3000.0}) {
    const double numeric = (air.density(height + kHalf) - air.density(height - kHalf)) / (2.0 * kHalf);
    EXPECT_NEAR(air.density_profile(height).gradient, numeric, kDifference);
  }
}

TEST(AirTest, ExpandsTheDensityAroundAHeight) {
  const Air air(AirParams{}, 1387.0);
  constexpr double kFourthTerm = 2e-13;  // relative: (1 m / 8400 m)^3 / 6, rounding
  for (const double height : {-50.0, 0.0, 120.0, 3000.0}) {
    const DensityProfile profile = air.density_profile(height);
    for (const double away : {-1.0, 0.3, 1.0}) {
      EXPECT_NEAR(profile.at(height + away) / air.density(height + away), 1.0, kFourthTerm);
    }
  }
}

TEST(AirTest, IsInHydrostaticBalance) {
  const Air air(AirParams{}, 0.0);
  constexpr double kHalf = 1.0;  // m
  constexpr double kGravityFalls =
      1e-3;  // relative: gravity shrinks with height, the standard's heights account for it
  for (const double height : {0.0, 1000.0, 2000.0}) {
    const double dp_dh = (air.pressure(height + kHalf) - air.pressure(height - kHalf)) / (2.0 * kHalf);
    EXPECT_NEAR(-dp_dh / (air.density(height) * 9.80665), 1.0, kGravityFalls);
  }
}

TEST(AirTest, CanBeTheSameEverywhere) {
  const Air air(AirParams{.constant_density = true, .density = 1.074}, 1387.0);
  EXPECT_EQ(air.density(0.0), 1.074);
  EXPECT_EQ(air.density(500.0), 1.074);
  EXPECT_EQ(air.density_profile(500.0).gradient, 0.0);
  EXPECT_LT(air.pressure(500.0), air.pressure(0.0));
}

TEST(AirTest, HoldsTheTropopausesValuesAboveIt) {
  const Air air(AirParams{}, 0.0);
  EXPECT_EQ(air.density(12000.0), air.density(13000.0));
  EXPECT_EQ(air.density_profile(12000.0).gradient, 0.0);
}

TEST(AirTest, IsThinnerOnAHotDay) {
  const Air hot(AirParams{.sea_level_temperature = 308.15}, 0.0);
  EXPECT_NEAR(hot.density(0.0) / 1.2250, 288.15 / 308.15, 1e-5);
}

}  // namespace
}  // namespace ironbird::simulator
