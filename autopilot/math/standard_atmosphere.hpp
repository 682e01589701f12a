#pragma once

namespace ironbird::autopilot {

// The U.S. Standard Atmosphere of 1976 below 11 km: temperature falls linearly with altitude. Altitudes are
// geopotential, m above mean sea level, and are clamped to -1000 .. 11000.

/// K.
double standard_temperature(double altitude);

/// Pa.
double standard_pressure(double altitude);

/// kg/m^3.
double standard_density(double altitude);

/// The altitude at which the standard atmosphere has `pressure` (Pa, > 0), m. Inverse of standard_pressure.
double standard_altitude(double pressure);

/// Relative change of density per metre of altitude, 1/m, negative.
double standard_density_gradient(double altitude);

}  // namespace ironbird::autopilot
