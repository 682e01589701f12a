#pragma once

#include <chrono>
#include <memory>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/types/rotor_commands.hpp"
#include "simulator/types/time.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

inline constexpr Time kTick = std::chrono::microseconds(2500);

/// A kind of plant.
struct Engine {
  const char* name;
  std::unique_ptr<Plant> (*make)(const VehicleParams&, const FieldParams&);
};

/// The same throttle for every rotor.
inline RotorCommands all(double throttle) {
  RotorCommands commands;
  commands.throttle.fill(throttle);
  return commands;
}

/// The reference multirotor with what it lacks: rotors that need time and a battery that sags.
inline VehicleParams test_vehicle() {
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3.8e-4;
  params.ground_effect.kind = GroundEffectKind::kNone;
  params.battery.constant_voltage = 0.0;
  params.battery.resistance = 0.015;
  return params;
}

}  // namespace ironbird::simulator
