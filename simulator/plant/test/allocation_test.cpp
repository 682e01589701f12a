// A step takes no memory from the heap: every call of malloc in this program is counted, ours and the
// engines'.

#include <gtest/gtest.h>

#include "simulator/plant/test/counted_malloc.hpp"
#include "simulator/plant/test/plants.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {
namespace {

template <class Engine>
class AllocationTest : public ::testing::Test {};

TYPED_TEST_SUITE(AllocationTest, Plants, PlantName);

long allocations_while_stepping(Plant& plant, double height) {
  EnvironmentParams environment_params;
  environment_params.wind.gusts.amplitude = 1.0;
  environment_params.wind.turbulence.wind_at_20_feet = 5.0;
  Environment environment(environment_params, 1);
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3e-4;
  params.battery.constant_voltage = 0.0;
  Vehicle vehicle(params, environment);
  plant.configure(vehicle.mass_properties(), environment.gravity());
  RigidBodyState state;
  state.p_NB_N.z() = -height;
  plant.reset(state, RotorSpeeds::Zero());
  long before = 0;
  constexpr int kWarmUp = 200;  // the engines grow their work space in the first steps with contact
  for (int i = 0; i < 2000; ++i) {
    if (i == kWarmUp) before = calls_of_malloc;
    environment.advance(0.5e-3, plant.state().p_NB_N, plant.state().v_NB_N);
    vehicle.set_commands(RotorCommands{});
    plant.step(0.5e-3, vehicle);
    vehicle.finish_step(0.5e-3, plant.state(), plant.rotors());
  }
  return calls_of_malloc - before;
}

TYPED_TEST(AllocationTest, TakesNothingInFlightNorOnTheGround) {
  for (const double height : {100.0, 0.22}) {
    const std::unique_ptr<Plant> plant = TypeParam::make(reference_multirotor(), FieldParams{});
    EXPECT_EQ(allocations_while_stepping(*plant, height), 0) << "from a height of " << height << " m";
  }
}

TEST(CountTest, SeesAnAllocation) {
  const long before = calls_of_malloc;
  delete new volatile int(1);
  EXPECT_GT(calls_of_malloc, before);
}

}  // namespace
}  // namespace ironbird::simulator
