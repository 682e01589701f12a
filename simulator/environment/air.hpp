#pragma once

namespace ironbird::simulator {

/// The day's air.
struct AirParams {
  double sea_level_pressure = 101325.0;
  double sea_level_temperature = 288.15;
  bool constant_density = false;
  double density = 1.225;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("sea_level_pressure", self.sea_level_pressure, "Pa", "static pressure at mean sea level", 80e3,
          120e3);
    visit("sea_level_temperature", self.sea_level_temperature, "K", "temperature at mean sea level", 200.0,
          340.0);
    visit("constant_density", self.constant_density, "1",
          "take `density` everywhere instead of the atmosphere's");
    visit("density", self.density, "kg/m^3", "used only with constant_density", 0.0, 2.0);
  }
};

/// Density around one height, by its first three terms. Ten metres away the fourth is 1e-10 of the density,
/// one metre away 1e-13.
struct DensityProfile {
  double height = 0.0;
  double density = 0.0;
  double gradient = 0.0;
  double curvature = 0.0;

  double at(double other_height) const {
    const double d = other_height - height;
    return density + d * (gradient + 0.5 * d * curvature);
  }

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("height", self.height, "m", "above the local origin, where the terms are taken");
    visit("density", self.density, "kg/m^3", "there");
    visit("gradient", self.gradient, "kg/m^4", "its slope upwards");
    visit("curvature", self.curvature, "kg/m^5", "its second derivative");
  }
};

/// The troposphere of the U.S. Standard Atmosphere 1976, shifted to the day's sea-level pressure and
/// temperature.
///
/// Geometric heights are turned into geopotential ones. Holds up to 11 km above mean sea level, the
/// tropopause; higher is answered as there.
class Air {
 public:
  /// @param home_altitude  of the local origin, m above mean sea level
  Air(const AirParams& params, double home_altitude);

  /// At a height above the local origin, m: K, Pa and kg/m^3.
  double temperature(double altitude_above_home) const;
  double pressure(double altitude_above_home) const;
  double density(double altitude_above_home) const { return density_profile(altitude_above_home).density; }
  DensityProfile density_profile(double altitude_above_home) const;

 private:
  AirParams params_;
  double home_altitude_;
};

}  // namespace ironbird::simulator
