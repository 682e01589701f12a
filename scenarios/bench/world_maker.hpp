#pragma once

#include <memory>

#include "scenarios/bench/scenario.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {

/// The world that a scenario describes: vehicle, engine, environment and sensors, at its start.
/// @throws std::invalid_argument naming key, value and bound
std::unique_ptr<simulator::World> make_world(const Scenario& scenario);

}  // namespace ironbird::scenarios
