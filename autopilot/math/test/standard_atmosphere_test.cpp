#include "autopilot/math/standard_atmosphere.hpp"

#include <gtest/gtest.h>

namespace ironbird::autopilot {
namespace {

// Published table of 1976, geopotential altitude. The table has five to six digits.
struct TableRow {
  double altitude, temperature, pressure, density;
};
constexpr double kTableDigits = 2.0e-5;
constexpr TableRow kTable[] = {{0.0, 288.15, 101325.0, 1.2250},
                               {1000.0, 281.65, 89874.6, 1.11164},
                               {2000.0, 275.15, 79495.2, 1.00649},
                               {5000.0, 255.65, 54019.9, 0.736116},
                               {11000.0, 216.65, 22632.1, 0.363918}};

TEST(StandardAtmosphereTest, AgreesWithThePublishedTable) {
  for (const TableRow& row : kTable) {
    EXPECT_NEAR(standard_temperature(row.altitude), row.temperature, 1.0e-9);
    EXPECT_NEAR(standard_pressure(row.altitude) / row.pressure, 1.0, kTableDigits) << row.altitude;
    EXPECT_NEAR(standard_density(row.altitude) / row.density, 1.0, kTableDigits) << row.altitude;
  }
}

TEST(StandardAtmosphereTest, InvertsItself) {
  constexpr double kRoundOff = 1.0e-7;  // m
  for (const double altitude : {-500.0, 0.0, 1387.0, 9000.0}) {
    EXPECT_NEAR(standard_altitude(standard_pressure(altitude)), altitude, kRoundOff);
  }
}

TEST(StandardAtmosphereTest, IsInHydrostaticBalance) {
  constexpr double kStep = 1.0;  // m
  for (const double altitude : {0.0, 1387.0, 8000.0}) {
    const double slope =
        (standard_pressure(altitude + kStep) - standard_pressure(altitude - kStep)) / (2.0 * kStep);
    EXPECT_NEAR(slope / (-standard_density(altitude) * 9.80665), 1.0, 1.0e-7);
    const double bend =
        (standard_density(altitude + kStep) - standard_density(altitude - kStep)) / (2.0 * kStep);
    EXPECT_NEAR(bend / standard_density(altitude) / standard_density_gradient(altitude), 1.0, 1.0e-6);
  }
}

TEST(StandardAtmosphereTest, EndsAtTheTropopause) {
  EXPECT_EQ(standard_pressure(20000.0), standard_pressure(11000.0));
  EXPECT_EQ(standard_altitude(1000.0), 11000.0);
}

}  // namespace
}  // namespace ironbird::autopilot
