#include "simulator/environment/air.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

// U.S. Standard Atmosphere 1976, table 2 and section 1.
constexpr double kEarthRadius = 6356766.0;            // m, of the geopotential
constexpr double kLapseRate = 0.0065;                 // K/m
constexpr double kGravity = 9.80665;                  // m/s^2
constexpr double kGasConstant = 8.31432e3 / 28.9644;  // J/(kg K)
constexpr double kExponent = kGravity / (kGasConstant * kLapseRate);
constexpr double kTropopause = 11000.0;  // m, geopotential

double geopotential(double altitude) {
  return std::min(altitude * kEarthRadius / (kEarthRadius + altitude), kTropopause);
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

double Air::density(double altitude_above_home) const {
  if (params_.constant_density) return params_.density;
  const double T = temperature(altitude_above_home);
  const double p = params_.sea_level_pressure * std::pow(T / params_.sea_level_temperature, kExponent);
  return p / (kGasConstant * T);
}

double Air::density_gradient(double altitude_above_home) const {
  const double altitude = home_altitude_ + altitude_above_home;
  if (params_.constant_density || geopotential(altitude) >= kTropopause) return 0.0;
  // rho is proportional to T^(n - 1) and T falls linearly with the geopotential height H.
  const double shrink = kEarthRadius / (kEarthRadius + altitude);
  const double dT_dh = -kLapseRate * shrink * shrink;
  return density(altitude_above_home) * (kExponent - 1.0) * dT_dh / temperature(altitude_above_home);
}

}  // namespace ironbird::simulator
