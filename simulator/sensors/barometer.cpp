#include "simulator/sensors/barometer.hpp"

#include <cmath>

namespace ironbird::simulator {

namespace {

// Constants of the reference simulator's formula.
constexpr double kReferencePressure = 101325.0;  // Pa
constexpr double kReferenceSlope = 2.25694e-5;   // 1/m
constexpr double kReferenceExponent = 5.2553;

}  // namespace

Barometer::Barometer(const BarometerParams& params, const SensorSite& site, double period, std::uint64_t seed)
    : params_(params),
      home_altitude_(site.altitude),
      air_(site.air, site.altitude),
      error_(params.error, period, seed, "sensors/barometer") {}

double Barometer::still_pressure(double height) const {
  if (params_.model == PressureModel::kEnvironment) return air_.pressure(height);
  return kReferencePressure * std::pow(1.0 - kReferenceSlope * (height + home_altitude_), kReferenceExponent);
}

BaroReading Barometer::measure(const Truth& truth, Time now, const FaultState& faults, bool /*armed*/) {
  double wash = 0.0;
  for (const double speed : truth.rotor_speed) wash += params_.rotor_wash * speed * speed;
  const double airspeed_squared = (truth.v_NB_N - truth.wind_N).squaredNorm();
  const double wind = params_.wind_coefficient * 0.5 * truth.air_density * airspeed_squared;

  BaroReading reading;
  reading.taken = now;
  reading.pressure = error_.apply(still_pressure(-truth.p_NB_N.z()) + wash + wind, faults.baro_bias);
  reading.temperature = params_.temperature;
  return reading;
}

}  // namespace ironbird::simulator
