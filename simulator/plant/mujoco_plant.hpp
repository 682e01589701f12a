#pragma once

#include <memory>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// MuJoCo's fourth-order integrator and contact, with the forces asked in each of its stages.
///
/// The model is built from the numbers given here and is as lean as contact allows: one body, spherical feet,
/// a box, the ground and the obstacles. Contact is switched off while everything is out of reach, which
/// changes nothing but the cost. Many plants can live at once. Not for use from several threads at once while
/// one is being constructed.
/// @throws std::invalid_argument when the engine refuses the model
std::unique_ptr<Plant> make_mujoco_plant(const VehicleParams& vehicle, const FieldParams& field);

}  // namespace ironbird::simulator
