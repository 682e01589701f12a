#include "simulator/sensors/magnetometer.hpp"

namespace ironbird::simulator {

Magnetometer::Magnetometer(const MagnetometerParams& params, const SensorSite& site, double period,
                           std::uint64_t seed)
    : params_(params),
      R_SB_(params.mounting.R_BS().transpose()),
      m_N_(site.magnetic_field_N),
      error_(params.error, period, seed, "sensors/magnetometer") {}

MagReading Magnetometer::measure(const Truth& truth, Time now, const FaultState& faults, bool /*armed*/) {
  const Vector3 earth_B = truth.q_NB.conjugate() * m_N_;
  const Vector3 m_B =
      params_.soft_iron * earth_B + params_.hard_iron_B + params_.current_coupling_B * truth.battery_current;
  MagReading reading;
  reading.taken = now;
  reading.m_B = error_.apply(R_SB_ * m_B, faults.mag_bias);
  return reading;
}

}  // namespace ironbird::simulator
