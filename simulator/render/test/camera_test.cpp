#include "simulator/render/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace ironbird::simulator {
namespace {

constexpr double kRoundOff = 1e-9;  // px, of a few products of numbers near a thousand

TEST(ProjectionTest, PutsTheTargetInTheMiddle) {
  const Projection projection(Camera{{-3.0, 2.0, -4.0}, {5.0, 1.0, -2.0}, 0.8}, 1280, 720);
  const auto point = projection.project({5.0, 1.0, -2.0});
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->u, 640.0, kRoundOff);
  EXPECT_NEAR(point->v, 360.0, kRoundOff);
  EXPECT_NEAR(point->depth, (Vector3(5.0, 1.0, -2.0) - Vector3(-3.0, 2.0, -4.0)).norm(), kRoundOff);
}

TEST(ProjectionTest, PutsEastRightAndUpUpwardsWhenLookingNorth) {
  // Half the picture's height is tan(45 deg) = 1 m at one metre: 360 px per metre there, 36 at ten.
  const Projection projection(Camera{{0.0, 0.0, -2.0}, {10.0, 0.0, -2.0}, std::acos(0.0)}, 1280, 720);
  const auto point = projection.project({10.0, 3.0, -4.0});
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->u, 640.0 + 3.0 * 36.0, kRoundOff);
  EXPECT_NEAR(point->v, 360.0 - 2.0 * 36.0, kRoundOff);
}

TEST(ProjectionTest, PutsNorthUpWhenLookingDown) {
  const Projection projection(Camera{{0.0, 0.0, -10.0}, {0.0, 0.0, 0.0}, std::acos(0.0)}, 720, 720);
  const auto north = projection.project({5.0, 0.0, 0.0});
  const auto east = projection.project({0.0, 5.0, 0.0});
  ASSERT_TRUE(north && east);
  EXPECT_NEAR(north->v, 180.0, kRoundOff);
  EXPECT_NEAR(north->u, 360.0, kRoundOff);
  EXPECT_NEAR(east->u, 540.0, kRoundOff);
}

TEST(ProjectionTest, RayAndProjectionAreInverse) {
  const Projection projection(Camera{{-3.0, 2.0, -4.0}, {5.0, 1.0, -2.0}, 0.8}, 640, 360);
  const auto point = projection.project(projection.p_N() + 7.0 * projection.ray_N(123.0, 45.0));
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->u, 123.0, kRoundOff);
  EXPECT_NEAR(point->v, 45.0, kRoundOff);
  EXPECT_NEAR(point->depth, 7.0, kRoundOff);
}

TEST(ProjectionTest, SeesNothingBehindItself) {
  const Projection projection(Camera{{0.0, 0.0, -2.0}, {10.0, 0.0, -2.0}, 0.8}, 640, 360);
  EXPECT_FALSE(projection.project({-1.0, 0.0, -2.0}));
}

TEST(ProjectionTest, RefusesACameraInItsTargetOrAnImpossibleLens) {
  EXPECT_THROW(Projection(Camera{{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 0.8}, 64, 64), std::invalid_argument);
  EXPECT_THROW(Projection(Camera{{0.0, 0.0, -2.0}, {1.0, 0.0, -2.0}, 3.1}, 64, 64), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::simulator
