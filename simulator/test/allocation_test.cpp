// A step of the world takes no memory from the heap: every `new` of this program is counted. What engines
// take is counted in the room of the plants.

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/test/test_vehicle.hpp"
#include "simulator/world.hpp"

namespace {
std::atomic<long> calls_of_new{0};

void* counted(std::size_t size) {
  ++calls_of_new;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace ironbird::simulator {
namespace {

TEST(AllocationTest, StepsWithoutTakingMemory) {
  WorldConfig config;
  config.vehicle = test_vehicle();
  config.on_ground = false;
  config.environment.wind.gusts.amplitude = 1.0;
  config.environment.wind.turbulence.wind_at_20_feet = 5.0;
  config.sensors.imu.gyro.noise_density = 1e-3;
  config.sensors.gnss.horizontal.instability_sigma = 1.0;
  config.sensors.gnss.timing.latency = 0.3;
  config.sensors.range_finder.timing.enabled = true;
  config.sensors.airspeed.timing.enabled = true;
  World world(config, std::make_unique<RigidBodyPlant>());
  world.begin({.kind = FaultKind::kImuNonFinite});
  world.begin({.kind = FaultKind::kWind, .vector = Vector3(1.0, 0.0, 0.0)});
  RotorCommands commands;
  commands.throttle.fill(world.vehicle().equilibrium_command());
  const long before = calls_of_new;
  for (int i = 0; i < 1000; ++i) world.step(commands, (i + 1) * kTick);
  EXPECT_EQ(calls_of_new - before, 0);
  EXPECT_GT(before, 0);  // the counter is the one in use
}

}  // namespace
}  // namespace ironbird::simulator
