#include "autopilot/math/local_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ironbird::autopilot {
namespace {

constexpr double kRoundOff = 1.0e-8;  // m: a radian of latitude in double is good to 1e-9 m

LocalOrigin provo() {
  return {.known = true, .latitude = 0.7024316, .longitude = -1.9486144, .altitude = 1387.0};
}

TEST(LocalMapTest, PutsTheOriginAtZero) {
  EXPECT_EQ(local_from_geodetic(provo().latitude, provo().longitude, provo()), Vector2(0.0, 0.0));
}

TEST(LocalMapTest, MeasuresAnArcOfTheMeridian) {
  const Vector2 p = local_from_geodetic(provo().latitude + 1.0e-5, provo().longitude, provo());
  EXPECT_NEAR(p.x(), 63.78145, kRoundOff);
  EXPECT_EQ(p.y(), 0.0);
}

TEST(LocalMapTest, MeasuresAnArcOfTheParallel) {
  const Vector2 p = local_from_geodetic(provo().latitude, provo().longitude + 1.0e-5, provo());
  EXPECT_NEAR(p.y(), 63.78145 * std::cos(provo().latitude), kRoundOff);
}

TEST(LocalMapTest, ReturnsToTheSamePlace) {
  for (const Vector3& p_N :
       {Vector3(0.0, 0.0, 0.0), Vector3(120.0, -340.0, -55.0), Vector3(-9000.0, 8000.0, 3.0)}) {
    const Vector3 back = local_from_geodetic(geodetic_from_local(p_N, provo()), provo());
    EXPECT_LT((back - p_N).norm(), kRoundOff);
  }
}

TEST(LocalMapTest, CrossesTheDateLine) {
  LocalOrigin origin = provo();
  origin.longitude = std::numbers::pi - 1.0e-6;
  const GeodeticPosition place = geodetic_from_local({0.0, 50.0, 0.0}, origin);
  EXPECT_LT(place.longitude, 0.0);
  EXPECT_NEAR(local_from_geodetic(place, origin).y(), 50.0, kRoundOff);
}

}  // namespace
}  // namespace ironbird::autopilot
