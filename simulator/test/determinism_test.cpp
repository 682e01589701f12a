#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/test/test_vehicle.hpp"
#include "simulator/world.hpp"

namespace ironbird::simulator {
namespace {

std::unique_ptr<Plant> make_rigid_body_plant(const VehicleParams&, const FieldParams&) {
  return std::make_unique<RigidBodyPlant>();
}

/// Collects the bits of every number of a described struct.
struct Bits {
  std::vector<std::uint64_t>& out;

  template <class Value>
  void operator()(const char*, const Value& value, const char*, const char*) const {
    put(value);
  }
  void put(double value) const { out.push_back(std::bit_cast<std::uint64_t>(value)); }
  void put(int value) const { out.push_back(static_cast<std::uint64_t>(value)); }
  void put(bool value) const { out.push_back(value ? 1 : 0); }
  void put(Time value) const { out.push_back(static_cast<std::uint64_t>(value.count())); }
  void put(const Vector3& value) const {
    for (const double component : value) put(component);
  }
  void put(const Quaternion& value) const {
    for (const double component : value.coeffs()) put(component);
  }
  template <std::size_t n>
  void put(const std::array<double, n>& values) const {
    for (const double value : values) put(value);
  }
  template <class Reading>
  void put(const std::optional<Reading>& reading) const {
    out.push_back(reading ? 1 : 0);
    if (reading) Reading::describe(*reading, *this);
  }
};

WorldConfig windy(std::uint64_t seed) {
  WorldConfig config;
  config.vehicle = test_vehicle();
  config.environment.wind.steady_N = Vector3(2.0, 1.0, 0.0);
  config.environment.wind.gusts.amplitude = 1.0;
  config.environment.wind.turbulence.wind_at_20_feet = 7.7;
  config.sensors.imu.accelerometer.noise_density = 2e-3;
  config.sensors.imu.gyro.noise_density = 2e-4;
  config.sensors.imu.gyro.random_walk = 1e-5;
  config.sensors.gnss.horizontal.instability_sigma = 1.0;
  config.sensors.barometer.error.noise_sigma = 1.0;
  config.seed = seed;
  return config;
}

struct Trace {
  std::vector<std::uint64_t> truth;
  std::vector<std::uint64_t> readings;
};

Trace fly(const WorldConfig& config, const Engine& engine) {
  World world(config, engine.make(config.vehicle, FieldParams{}));
  Trace trace;
  const double hover = world.vehicle().equilibrium_command();
  for (int i = 0; i < 800; ++i) {
    RotorCommands commands;
    for (int rotor = 0; rotor < 4; ++rotor) {
      commands.throttle[static_cast<std::size_t>(rotor)] = 1.1 * hover + 0.01 * std::sin(0.1 * i + rotor);
    }
    if (i == 200) world.begin({.kind = FaultKind::kPayload, .magnitude = 0.3});
    world.step(commands, (i + 1) * kTick);
    Truth::describe(world.truth(), Bits{trace.truth});
    Readings::describe(world.readings(), Bits{trace.readings});
  }
  return trace;
}

class DeterminismTest : public ::testing::TestWithParam<Engine> {};

TEST_P(DeterminismTest, GivesTheSameBitsForTheSameSeed) {
  const Trace first = fly(windy(3), GetParam()), second = fly(windy(3), GetParam());
  EXPECT_EQ(first.truth, second.truth);
  EXPECT_EQ(first.readings, second.readings);
}

TEST_P(DeterminismTest, GivesOtherBitsForAnotherSeed) {
  const Trace first = fly(windy(3), GetParam()), second = fly(windy(4), GetParam());
  EXPECT_NE(first.truth, second.truth);
  EXPECT_NE(first.readings, second.readings);
}

TEST_P(DeterminismTest, KeepsTheTruthWhenASensorIsAdded) {
  WorldConfig more = windy(3);
  more.sensors.range_finder.timing.enabled = true;
  more.sensors.range_finder.error.noise_sigma = 0.1;
  more.sensors.magnetometer.error.noise_sigma = 1e-7;
  const Trace first = fly(windy(3), GetParam()), second = fly(more, GetParam());
  EXPECT_EQ(first.truth, second.truth);
  EXPECT_NE(first.readings, second.readings);
}

INSTANTIATE_TEST_SUITE_P(Engines, DeterminismTest,
                         ::testing::Values(Engine{"RigidBody", make_rigid_body_plant},
                                           Engine{"Mujoco", make_mujoco_plant},
                                           Engine{"Ode", make_ode_plant}),
                         [](const auto& sample) { return sample.param.name; });

}  // namespace
}  // namespace ironbird::simulator
