#include "simulator/sensors/airspeed.hpp"

#include <cmath>

namespace ironbird::simulator {

Airspeed::Airspeed(const AirspeedParams& params, const SensorSite& /*site*/, double period,
                   std::uint64_t seed)
    : params_(params), error_(params.error, period, seed, "sensors/airspeed") {}

AirspeedReading Airspeed::measure(const Truth& truth, Time now, const FaultState& /*faults*/,
                                  bool /*armed*/) {
  const Vector3 v_air_N = truth.v_NB_N - truth.wind_N;
  const double u = v_air_N.dot(truth.q_NB * Vector3::UnitX());
  const double pressure = 0.5 * truth.air_density * u * (params_.keeps_sign ? std::abs(u) : u);
  AirspeedReading reading;
  reading.taken = now;
  reading.differential_pressure = error_.apply(pressure);
  reading.temperature = params_.temperature;
  return reading;
}

}  // namespace ironbird::simulator
