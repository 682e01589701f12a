#include "simulator/fault/fault_state.hpp"

#include <cassert>
#include <cstddef>

namespace ironbird::simulator {

void add(const Fault& fault, FaultState& state) {
  const std::size_t rotor = static_cast<std::size_t>(fault.index);
  switch (fault.kind) {
    case FaultKind::kRotorEfficiency:
      assert(rotor < state.rotor_efficiency.size());
      state.rotor_efficiency[rotor] *= fault.magnitude;
      return;
    case FaultKind::kRotorLoss:
      assert(rotor < state.rotor_efficiency.size());
      state.rotor_efficiency[rotor] = 0.0;
      return;
    case FaultKind::kImuDropout:
      state.imu.dropout = true;
      return;
    case FaultKind::kMagDropout:
      state.mag.dropout = true;
      return;
    case FaultKind::kBaroDropout:
      state.baro.dropout = true;
      return;
    case FaultKind::kGnssDropout:
      state.gnss.dropout = true;
      return;
    case FaultKind::kImuNonFinite:
      state.imu.non_finite = true;
      return;
    case FaultKind::kMagNonFinite:
      state.mag.non_finite = true;
      return;
    case FaultKind::kBaroNonFinite:
      state.baro.non_finite = true;
      return;
    case FaultKind::kGnssNonFinite:
      state.gnss.non_finite = true;
      return;
    case FaultKind::kAccelerometerBias:
      state.accelerometer_bias += fault.vector;
      return;
    case FaultKind::kGyroBias:
      state.gyro_bias += fault.vector;
      return;
    case FaultKind::kMagBias:
      state.mag_bias += fault.vector;
      return;
    case FaultKind::kBaroBias:
      state.baro_bias += fault.magnitude;
      return;
    case FaultKind::kGnssJump:
      state.gnss_jump_N += fault.vector;
      return;
    case FaultKind::kBatteryCharge:
      return;
    case FaultKind::kWind:
      state.wind_N += fault.vector;
      return;
    case FaultKind::kPayload:
      state.payload += fault.magnitude;
      return;
  }
}

FaultState combine(std::span<const Fault> faults) {
  FaultState state;
  for (const Fault& fault : faults) add(fault, state);
  return state;
}

}  // namespace ironbird::simulator
