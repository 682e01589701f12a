// The real vehicle in every plant: rotors with inertia, sagging battery, wind, drag, ground effect.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "simulator/plant/test/plants.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {
namespace {

VehicleParams lagging() {
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3e-4;
  params.rotor.resistance = 0.108;
  params.ground_effect.kind = GroundEffectKind::kThrustProportional;
  params.battery = {.resistance = 0.02};
  return params;
}

struct End {
  RigidBodyState state;
  RotorSpeeds rotors;
};

/// Two seconds of a climbing turn in wind, the rotors commanded unevenly.
End climb(Plant& plant, const VehicleParams& params, double dt) {
  EnvironmentParams environment_params;
  environment_params.wind.steady_N = {3.0, -2.0, 0.0};
  const Environment environment(environment_params, 1);
  Vehicle vehicle(params, environment);
  const double hover = vehicle.equilibrium_command();
  RotorCommands commands;
  commands.throttle = {hover * 1.1, hover * 1.101, hover * 1.1, hover * 1.099};
  vehicle.set_commands(commands);
  RigidBodyState state;
  state.p_NB_N.z() = -40.0;
  state.v_NB_N = {2.0, 1.0, -3.0};
  state.w_NB_B = {0.05, 0.1, 0.3};
  plant.configure(vehicle.mass_properties(), environment.gravity());
  plant.reset(state, vehicle.equilibrium_speeds());
  const int steps = static_cast<int>(std::lround(2.0 / dt));
  for (int i = 0; i < steps; ++i) plant.step(dt, vehicle);
  return {plant.state(), plant.rotors()};
}

template <class Engine>
class VehicleFlightTest : public ::testing::Test {
 protected:
  std::unique_ptr<Plant> plant_ = Engine::make(lagging(), FieldParams{});
};

TYPED_TEST_SUITE(VehicleFlightTest, Plants, PlantName);

TYPED_TEST(VehicleFlightTest, ClimbsAsInTheOracle) {
  RigidBodyPlant oracle;
  const End reference = climb(oracle, lagging(), 0.125e-3);
  const End end = climb(*this->plant_, lagging(), 0.5e-3);
  EXPECT_LT((end.state.p_NB_N - reference.state.p_NB_N).norm(), TypeParam::kFlightPosition);
  constexpr double kSpeed = 1e-4;  // rad/s, of 400
  EXPECT_LT((end.rotors - reference.rotors).abs().maxCoeff(), kSpeed);
}

TYPED_TEST(VehicleFlightTest, GainsTheOrderOfItsScheme) {
  RigidBodyPlant oracle;
  const End reference = climb(oracle, lagging(), 0.125e-3);
  const auto error = [&](double dt) {
    return (climb(*this->plant_, lagging(), dt).state.p_NB_N - reference.state.p_NB_N).norm();
  };
  const double finest = 2.0 * TypeParam::kFinest;
  const double order = std::log2(error(2.0 * finest) / error(finest));
  EXPECT_GT(order, TypeParam::kLeastOrder);
  EXPECT_LT(order, TypeParam::kMostOrder + 0.3);
}

TYPED_TEST(VehicleFlightTest, ClimbsAsInTheOracleWithInstantaneousRotors) {
  VehicleParams params = reference_multirotor();
  params.ground_effect.kind = GroundEffectKind::kNone;
  RigidBodyPlant oracle;
  const End reference = climb(oracle, params, 0.125e-3);
  const End end = climb(*this->plant_, params, 0.5e-3);
  EXPECT_LT((end.state.p_NB_N - reference.state.p_NB_N).norm(), TypeParam::kFlightPosition);
  EXPECT_GT(end.rotors[0], 300.0);
  constexpr double kSpeed = 1e-4;
  EXPECT_LT((end.rotors - reference.rotors).abs().maxCoeff(), kSpeed);
}

TYPED_TEST(VehicleFlightTest, HoversAtItsEquilibrium) {
  EnvironmentParams environment_params;
  environment_params.air.constant_density = true;
  const Environment environment(environment_params, 1);
  VehicleParams params = lagging();
  params.ground_effect.kind = GroundEffectKind::kNone;
  Vehicle vehicle(params, environment);
  RotorCommands commands;
  commands.throttle.fill(vehicle.equilibrium_command());
  vehicle.set_commands(commands);
  RigidBodyState state;
  state.p_NB_N.z() = -40.0;
  this->plant_->configure(vehicle.mass_properties(), environment.gravity());
  this->plant_->reset(state, vehicle.equilibrium_speeds());
  for (int i = 0; i < 4000; ++i) this->plant_->step(2.5e-3, vehicle);
  constexpr double kRounding = 1e-9;  // m, ten seconds with rounding in the balance of forces
  EXPECT_LT((this->plant_->state().p_NB_N - state.p_NB_N).norm(), kRounding);
}

TYPED_TEST(VehicleFlightTest, FliesTheSameInAnyThread) {
  const End here = climb(*this->plant_, lagging(), 0.5e-3);
  End there[2];
  std::unique_ptr<Plant> plants[2] = {TypeParam::make(lagging(), FieldParams{}),
                                      TypeParam::make(lagging(), FieldParams{})};
  std::thread first([&] { there[0] = climb(*plants[0], lagging(), 0.5e-3); });
  std::thread second([&] { there[1] = climb(*plants[1], lagging(), 0.5e-3); });
  first.join();
  second.join();
  for (const End& end : there) EXPECT_EQ(end.state.p_NB_N, here.state.p_NB_N);
}

}  // namespace
}  // namespace ironbird::simulator
