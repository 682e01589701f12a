#pragma once

#include <memory>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// ODE's exact stepper and contact, made second order in free flight by a mid-step wrench and a drift
/// correction; in contact plain steps of ODE's own, first order.
/// @throws std::invalid_argument when the engine refuses the model
std::unique_ptr<Plant> make_ode_plant(const VehicleParams& vehicle, const FieldParams& field);

}  // namespace ironbird::simulator
