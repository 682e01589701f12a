#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/test/test_vehicle.hpp"
#include "simulator/world.hpp"

namespace ironbird::simulator {
namespace {

WorldConfig falling() {
  WorldConfig config;
  config.vehicle = test_vehicle();
  config.vehicle.inertia = {.Jxx = 0.06, .Jyy = 0.08, .Jzz = 0.12};
  config.initial_p_NB_N = Vector3(0.0, 0.0, -100.0);
  config.on_ground = true;  // rotors at rest; the plant has no ground
  return config;
}

/// Kinetic and potential energy of the rigid body, J.
double energy(const World& world) {
  const Truth& truth = world.truth();
  const MassProperties& mass = world.vehicle().mass_properties();
  return 0.5 * mass.mass * truth.v_NB_N.squaredNorm() + 0.5 * truth.w_NB_B.dot(mass.J_Bcm_B * truth.w_NB_B) -
         mass.mass * world.environment().gravity() * truth.p_NB_N.z();
}

TEST(EnergyTest, IsConservedInFreeFall) {
  WorldConfig config = falling();
  config.vehicle.drag = DragParams{};
  World world(config, std::make_unique<RigidBodyPlant>());
  const double start = energy(world);
  for (int i = 0; i < 400; ++i) world.step(all(0.0), (i + 1) * kTick);
  constexpr double kRoundOff = 1e-9;  // J, of about 100
  EXPECT_NEAR(energy(world), start, kRoundOff);
  EXPECT_GT(world.truth().v_NB_N.norm(), 9.0);
}

TEST(EnergyTest, IsLostToDragAndToNothingElse) {
  World world(falling(), std::make_unique<RigidBodyPlant>());
  double lost = 0.0;
  const double start = energy(world);
  double before = start;
  double power_before = 0.0;
  for (int i = 0; i < 1200; ++i) {
    world.step(all(0.0), (i + 1) * kTick);
    const Truth& truth = world.truth();
    const double speed = truth.v_NB_N.norm();
    const DragParams& drag = world.vehicle().params().drag;
    const double power = 0.5 * truth.air_density * drag.CD * drag.area * speed * speed * speed;
    lost += 0.5 * (power_before + power) * seconds(kTick);
    power_before = power;
    ASSERT_LE(energy(world), before + 1e-9) << i;
    before = energy(world);
  }
  // The trapezium rule over 1200 ticks.
  EXPECT_NEAR((start - energy(world)) / lost, 1.0, 1e-4);
  EXPECT_GT(lost, 100.0);
}

TEST(EnergyTest, ReachesTheTerminalSpeed) {
  WorldConfig config = falling();
  config.environment.air.constant_density = true;
  World world(config, std::make_unique<RigidBodyPlant>());
  for (int i = 0; i < 8000; ++i) world.step(all(0.0), (i + 1) * kTick);
  const DragParams& drag = config.vehicle.drag;
  const double terminal = std::sqrt(2.0 * config.vehicle.mass * config.environment.gravity /
                                    (config.environment.air.density * drag.CD * drag.area));
  EXPECT_NEAR(world.truth().v_NB_N.z(), terminal, 1e-4);
}

}  // namespace
}  // namespace ironbird::simulator
