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

/// What an outage does to which sensor.
struct Deafened {
  Outage FaultState::*sensor = nullptr;
  bool Outage::*how = nullptr;
};

Deafened deafened_by(FaultKind kind) {
  switch (kind) {
    case FaultKind::kImuDropout:
      return {&FaultState::imu, &Outage::dropout};
    case FaultKind::kMagDropout:
      return {&FaultState::mag, &Outage::dropout};
    case FaultKind::kBaroDropout:
      return {&FaultState::baro, &Outage::dropout};
    case FaultKind::kGnssDropout:
      return {&FaultState::gnss, &Outage::dropout};
    case FaultKind::kImuNonFinite:
      return {&FaultState::imu, &Outage::non_finite};
    case FaultKind::kMagNonFinite:
      return {&FaultState::mag, &Outage::non_finite};
    case FaultKind::kBaroNonFinite:
      return {&FaultState::baro, &Outage::non_finite};
    case FaultKind::kGnssNonFinite:
      return {&FaultState::gnss, &Outage::non_finite};
    default:
      return {};
  }
}

using FaultVector = Vector3 FaultState::*;

/// The sum to which a fault with a direction adds.
FaultVector vector_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kAccelerometerBias:
      return &FaultState::accelerometer_bias;
    case FaultKind::kGyroBias:
      return &FaultState::gyro_bias;
    case FaultKind::kMagBias:
      return &FaultState::mag_bias;
    case FaultKind::kGnssJump:
      return &FaultState::gnss_jump_N;
    case FaultKind::kWind:
      return &FaultState::wind_N;
    default:
      return nullptr;
  }
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
  if (const Deafened deafened = deafened_by(fault.kind); deafened.sensor != nullptr) {
    (state.*deafened.sensor).*deafened.how = true;
    return;
  }
  if (const FaultVector vector = vector_of(fault.kind); vector != nullptr) {
    state.*vector += fault.vector;
    return;
  }
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
    case FaultKind::kBaroBias:
      state.baro_bias += fault.magnitude;
      return;
    case FaultKind::kPayload:
      state.payload += fault.magnitude;
      return;
    default:  // a battery's charge is an event
      return;
  }
}

FaultState combine(std::span<const Fault> faults) {
  FaultState state;
  for (const Fault& fault : faults) add(fault, state);
  return state;
}

}  // namespace ironbird::simulator
