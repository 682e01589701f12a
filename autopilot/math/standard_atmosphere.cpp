#include "autopilot/math/standard_atmosphere.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::autopilot {

namespace {

constexpr double kLowest = -1000.0;                 // m
constexpr double kTropopause = 11000.0;             // m
constexpr double kSeaLevelTemperature = 288.15;     // K
constexpr double kSeaLevelPressure = 101325.0;      // Pa
constexpr double kLapseRate = 0.0065;               // K/m
constexpr double kStandardGravity = 9.80665;        // m/s^2
constexpr double kGasConstant = 8314.32 / 28.9644;  // J/(kg K), the values of 1976
constexpr double kExponent = kStandardGravity / (kGasConstant * kLapseRate);

double bounded(double altitude) {
  return std::clamp(altitude, kLowest, kTropopause);
}

}  // namespace

double standard_temperature(double altitude) {
  return kSeaLevelTemperature - kLapseRate * bounded(altitude);
}

double standard_pressure(double altitude) {
  return kSeaLevelPressure * std::pow(standard_temperature(altitude) / kSeaLevelTemperature, kExponent);
}

double standard_density(double altitude) {
  return standard_pressure(altitude) / (kGasConstant * standard_temperature(altitude));
}

double standard_altitude(double pressure) {
  const double ratio = std::pow(pressure / kSeaLevelPressure, 1.0 / kExponent);
  return bounded(kSeaLevelTemperature * (1.0 - ratio) / kLapseRate);
}

double standard_density_gradient(double altitude) {
  // rho ~ T^(kExponent - 1) and dT/dh = -kLapseRate.
  return -(kExponent - 1.0) * kLapseRate / standard_temperature(altitude);
}

}  // namespace ironbird::autopilot
