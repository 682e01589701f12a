#include "simulator/environment/air.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

// U.S. Standard Atmosphere 1976, table 2 and section 1.
constexpr double kGeopotentialRadius = 6356766.0;     // m, of the geopotential
constexpr double kLapseRate = 0.0065;                 // K/m
constexpr double kGravity = 9.80665;                  // m/s^2
constexpr double kGasConstant = 8.31432e3 / 28.9644;  // J/(kg K)
constexpr double kExponent = kGravity / (kGasConstant * kLapseRate);
constexpr double kTropopause = 11000.0;  // m, geopotential

double geopotential(double altitude) {
  return std::min(altitude * kGeopotentialRadius / (kGeopotentialRadius + altitude), kTropopause);
}

}  // namespace

Air::Air(const AirParams& params, double home_altitude) : params_(params), home_altitude_(home_altitude) {}

double Air::temperature(double altitude_above_home) const {
  return params_.sea_level_temperature - kLapseRate * geopotential(home_altitude_ + altitude_above_home);
}

double Air::pressure(double altitude_above_home) const {
  const double ratio = temperature(altitude_above_home) / params_.sea_level_temperature;
  return params_.sea_level_pressure * std::pow(ratio, kExponent);
}

DensityProfile Air::density_profile(double altitude_above_home) const {
  if (params_.constant_density) return {altitude_above_home, params_.density, 0.0, 0.0};
  const double T = temperature(altitude_above_home);
  const double ratio = T / params_.sea_level_temperature;
  const double density = params_.sea_level_pressure * std::pow(ratio, kExponent) / (kGasConstant * T);
  const double altitude = home_altitude_ + altitude_above_home;
  if (geopotential(altitude) >= kTropopause) return {altitude_above_home, density, 0.0, 0.0};
  // The density is proportional to T^(n - 1), and T falls linearly with the geopotential height.
  const double shrink = kGeopotentialRadius / (kGeopotentialRadius + altitude);
  const double slope = -kLapseRate * shrink * shrink / T;           // dT/dh / T
  const double bend = -2.0 * slope * shrink / kGeopotentialRadius;  // d2T/dh2 / T
  const double power = kExponent - 1.0;
  return {altitude_above_home, density, density * power * slope,
          density * power * ((power - 1.0) * slope * slope + bend)};
}

}  // namespace ironbird::simulator
