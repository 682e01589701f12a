#pragma once

#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

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
