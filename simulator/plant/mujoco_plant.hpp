#pragma once

#include <memory>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// MuJoCo's fourth-order integrator and contact, with the forces asked in each of its stages.
///
/// Two models are built from the numbers given here: one body without shapes for the air, and one with
/// spherical feet, a box, the ground and the obstacles. The second takes over where something is within
/// reach, which changes nothing but the cost; while something is touched it steps with the engine's
/// first-order scheme. Position and attitude are second order in the step, with small constants, because the
/// engine adds up turns as vectors. Many plants can live at once, in many threads; the engine's loader is not
/// made for two constructions at once.
/// @throws std::invalid_argument when the engine refuses the model
std::unique_ptr<Plant> make_mujoco_plant(const VehicleParams& vehicle, const FieldParams& field);

}  // namespace ironbird::simulator
