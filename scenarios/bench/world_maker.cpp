#include "scenarios/bench/world_maker.hpp"

#include <array>
#include <stdexcept>

#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::scenarios {

namespace {

simulator::Vector3 vector(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

std::unique_ptr<simulator::Plant> make_plant(const Scenario& scenario) {
  const simulator::FieldParams field;
  switch (scenario.plant.engine) {
    case Engine::kMujoco:
      return simulator::make_mujoco_plant(scenario.vehicle, field);
    case Engine::kOde:
      return simulator::make_ode_plant(scenario.vehicle, field);
    case Engine::kRigidBody:
      return std::make_unique<simulator::RigidBodyPlant>();
  }
  throw std::invalid_argument("plant.engine: unknown");
}

simulator::WorldConfig world_config(const Scenario& scenario) {
  simulator::WorldConfig config;
  config.vehicle = scenario.vehicle;
  config.environment = scenario.environment;
  config.sensors = scenario.sensors;
  config.initial_p_NB_N = vector(scenario.start.p_N);
  config.initial_heading = scenario.start.heading;
  config.on_ground = scenario.start.on_ground;
  config.tick = scenario.fcu.tick;
  config.seed = scenario.seed;
  return config;
}

}  // namespace

std::unique_ptr<simulator::World> make_world(const Scenario& scenario) {
  return std::make_unique<simulator::World>(world_config(scenario), make_plant(scenario));
}

}  // namespace ironbird::scenarios
