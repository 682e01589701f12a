#include "simulator/fault/fault_state.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>

namespace ironbird::simulator {

namespace {

const char* name_of(FaultKind kind) {
  for (const auto& [value, name] : enumerators(FaultKind{})) {
    if (value == kind) return name.data();
  }
  return "unknown";
}

[[noreturn]] void refuse(FaultKind kind, const char* member, double value, const std::string& bound) {
  std::ostringstream message;
  message << "fault " << name_of(kind) << ": " << member << " = " << value << ", must be " << bound;
  throw std::invalid_argument(message.str());
}

}  // namespace

void check(const Fault& fault, int rotor_count) {
  const FaultKind kind = fault.kind;
  const double magnitude = fault.magnitude;
  if (!std::isfinite(magnitude)) refuse(kind, "magnitude", magnitude, "a finite number");
  for (const double component : fault.vector) {
    if (!std::isfinite(component)) refuse(kind, "vector", component, "a finite number");
  }
  const bool is_rotor = kind == FaultKind::kRotorEfficiency || kind == FaultKind::kRotorLoss;
  if (is_rotor && (fault.index < 0 || fault.index >= rotor_count)) {
    refuse(kind, "index", fault.index, "0.." + std::to_string(rotor_count - 1));
  }
  const bool is_share = kind == FaultKind::kRotorEfficiency || kind == FaultKind::kBatteryCharge;
  if (is_share && !(magnitude >= 0.0 && magnitude <= 1.0)) refuse(kind, "magnitude", magnitude, "0..1");
  if (kind == FaultKind::kPayload && magnitude < 0.0) refuse(kind, "magnitude", magnitude, ">= 0 kg");
}

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
