// The World Magnetic Model against somebody else's implementation, and against what is known without one.

#include "scenarios/replay/magnetic_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <vector>

namespace ironbird::scenarios {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
const std::filesystem::path kForeign =
    std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/replay/test/foreign";

struct Place {
  double year;
  double altitude;   // m
  double latitude;   // deg
  double longitude;  // deg
};

MagneticField field_at(const Place& place) {
  return magnetic_field(place.latitude / kDegrees, place.longitude / kDegrees, place.altitude, place.year);
}

TEST(MagneticFieldTest, AgreesWithSomebodyElses) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Place> places;
  for (int k = 0; k < 300; ++k)
    places.push_back({2015.1 + 14.8 * unit(random), 5000.0 * unit(random), -88.0 + 176.0 * unit(random),
                      -180.0 + 360.0 * unit(random)});
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "ironbird_places.txt";
  {
    std::ofstream out(file);
    out.precision(17);
    for (const Place& place : places)
      out << place.year << ' ' << place.altitude / 1000.0 << ' ' << place.latitude << ' ' << place.longitude
          << '\n';
  }
  FILE* const other = popen(
      ("node '" + (kForeign / "earth_field.mjs").string() + "' < '" + file.string() + "'").c_str(), "r");
  ASSERT_NE(other, nullptr);
  std::size_t same = 0;
  for (const Place& place : places) {
    double declination = 0.0, inclination = 0.0, nanotesla = 0.0;
    ASSERT_EQ(fscanf(other, "%lf %lf %lf", &declination, &inclination, &nanotesla), 3);
    const MagneticField ours = field_at(place);
    // The other one has an edition of 2015 beside ours, and changes over some weeks before a new one begins.
    if (std::abs(place.year - std::round(place.year)) < 0.2 || place.year < 2018.8) continue;
    ++same;
    EXPECT_NEAR(std::remainder(ours.declination * kDegrees - declination, 360.0), 0.0, 1e-3)
        << place.year << ' ' << place.latitude << ' ' << place.longitude;
    EXPECT_NEAR(ours.inclination * kDegrees, inclination, 1e-3);
    EXPECT_NEAR(ours.strength * 1e9, nanotesla, 1.0);
  }
  EXPECT_EQ(pclose(other), 0);
  EXPECT_GT(same, 100U);
}

// Of the values that NOAA publishes with WMM2025, at its epoch and height 0: 80 N 0 E, and 0 N 120 E.
TEST(MagneticFieldTest, GivesThePublishedValues) {
  const MagneticField north = field_at({2025.0, 0.0, 80.0, 0.0});
  EXPECT_NEAR(north.b_N.x() * 1e9, 6521.6, 0.1);
  EXPECT_NEAR(north.b_N.y() * 1e9, 145.9, 0.1);
  EXPECT_NEAR(north.b_N.z() * 1e9, 54791.5, 0.1);
  const MagneticField equator = field_at({2025.0, 0.0, 0.0, 120.0});
  EXPECT_NEAR(equator.b_N.x() * 1e9, 39677.8, 0.1);
  EXPECT_NEAR(equator.b_N.y() * 1e9, -109.6, 0.1);
  EXPECT_NEAR(equator.b_N.z() * 1e9, -10580.2, 0.1);
}

TEST(MagneticFieldTest, SaysWhichEditionItTookAndWhetherThatIsMeantForTheTime) {
  EXPECT_EQ(field_at({2016.0, 0.0, 47.0, 8.0}).edition, 2015);
  EXPECT_EQ(field_at({2023.4, 0.0, 47.0, 8.0}).edition, 2020);
  EXPECT_EQ(field_at({2026.0, 0.0, 47.0, 8.0}).edition, 2025);
  EXPECT_TRUE(field_at({2029.9, 0.0, 47.0, 8.0}).current);
  EXPECT_FALSE(field_at({2030.1, 0.0, 47.0, 8.0}).current);
  EXPECT_FALSE(field_at({2014.0, 0.0, 47.0, 8.0}).current);
}

TEST(MagneticFieldTest, IsANumberAtThePoles) {
  for (const double latitude : {-90.0, 90.0}) {
    const MagneticField pole = field_at({2025.5, 0.0, latitude, 30.0});
    EXPECT_TRUE(pole.b_N.allFinite());
    EXPECT_GT(pole.strength, 5e-5);
  }
}

TEST(MagneticFieldTest, KnowsTheDecimalYear) {
  EXPECT_DOUBLE_EQ(decimal_year(1704067200.0), 2024.0);
  EXPECT_NEAR(decimal_year(1719792000.0), 2024.0 + 182.0 / 366.0, 1e-12);
  EXPECT_DOUBLE_EQ(decimal_year(0.0), 1970.0);
}

}  // namespace
}  // namespace ironbird::scenarios
