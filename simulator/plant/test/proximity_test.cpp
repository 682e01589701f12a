#include "simulator/plant/proximity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ironbird::simulator {
namespace {

constexpr double kRounding = 1e-12;

ContactParams ball() {
  ContactParams params;
  params.feet = {{0.0, 0.0, 0.3}};
  params.foot_radius = 0.1;
  params.body_half_size = {0.1, 0.1, 0.1};
  return params;
}

TEST(ProximityTest, MeasuresFromTheOutermostPoint) {
  const Proximity proximity(ball(), FieldParams{});
  EXPECT_NEAR(proximity.clearance({7.0, 8.0, -2.0}), 1.6, kRounding);
  EXPECT_NEAR(proximity.clearance({7.0, 8.0, 1.0}), -1.4, kRounding);
}

TEST(ProximityTest, MeasuresToTurnedBoxes) {
  FieldParams field;
  field.ground = false;
  EXPECT_EQ(Proximity(ball(), field).clearance(Vector3::Zero()), std::numeric_limits<double>::infinity());
  field.boxes.push_back(
      {.position = {0.0, 0.0, -5.0}, .half_size = {2.0, 1.0, 1.0}, .heading = std::numbers::pi / 2.0});
  const Proximity proximity(ball(), field);
  EXPECT_NEAR(proximity.clearance({0.0, 3.0, -5.0}), 1.0 - 0.4, kRounding);  // east: the long side
  EXPECT_NEAR(proximity.clearance({3.0, 0.0, -5.0}), 2.0 - 0.4, kRounding);  // north: the short side
  EXPECT_NEAR(proximity.clearance({4.0, 6.0, -5.0}), 5.0 - 0.4, kRounding);  // a corner: 3, 4, 5
  EXPECT_NEAR(proximity.clearance({0.0, 0.0, -5.0}), -0.4, kRounding);       // inside
}

TEST(ProximityTest, ComesOnBeforeTheGroundIsReachedAtAnySpeed) {
  for (const double speed : {0.1, 5.0, 30.0, 100.0}) {
    Proximity proximity(ball(), FieldParams{});
    double height = 20.0;
    constexpr double kLongStep = 5e-3;  // s
    proximity.update({0.0, 0.0, -height}, speed);
    EXPECT_FALSE(proximity.near());
    while (!proximity.near()) {
      height -= speed * kLongStep;
      proximity.update({0.0, 0.0, -height}, speed);
    }
    EXPECT_GT(proximity.clearance({0.0, 0.0, -height}), speed * kLongStep);
  }
}

TEST(ProximityTest, DoesNotFlutter) {
  Proximity proximity(ball(), FieldParams{});
  proximity.update({0.0, 0.0, -10.0}, 0.0);
  proximity.update({0.0, 0.0, -0.44}, 0.0);
  ASSERT_TRUE(proximity.near());
  EXPECT_TRUE(proximity.update({0.0, 0.0, -0.46}, 0.0));
  EXPECT_FALSE(proximity.update({0.0, 0.0, -0.52}, 0.0));
  EXPECT_FALSE(proximity.update({0.0, 0.0, -0.46}, 0.0));
}

}  // namespace
}  // namespace ironbird::simulator
