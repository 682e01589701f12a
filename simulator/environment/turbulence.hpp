#pragma once

#include <cstdint>

#include "simulator/random/stream.hpp"
#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// How rough the air is.
struct TurbulenceParams {
  double wind_at_20_feet = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("wind_at_20_feet", self.wind_at_20_feet, "m/s",
          "W20, which sets the intensity: light 7.7, moderate 15.4, severe 23.2; 0: none", 0.0, 50.0);
  }
};

/// Length scales and standard deviations of the Dryden model, along and across the wind and vertically.
struct TurbulenceScale {
  double length_horizontal = 0.0;
  double length_vertical = 0.0;
  double sigma_horizontal = 0.0;
  double sigma_vertical = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("length_horizontal", self.length_horizontal, "m", "length of the gusts along and across the wind");
    visit("length_vertical", self.length_vertical, "m", "length of the vertical gusts");
    visit("sigma_horizontal", self.sigma_horizontal, "m/s", "their strength along and across the wind");
    visit("sigma_vertical", self.sigma_vertical, "m/s", "strength of the vertical gusts");
  }
};

/// Low-altitude scales at `height` above the ground, m, clamped to 10..1000 ft. Source: MIL-F-8785C,
/// section 3.7.3.
TurbulenceScale low_altitude_scale(double height, double wind_at_20_feet);

/// Continuous turbulence with Dryden spectra. Source: MIL-F-8785C, sections 3.7.2.2 and 3.7.3.
///
/// White noise through the Dryden filters, whose discrete form is exact for any step as long as height and
/// airspeed hold, and which start in their stationary state. The along-wind axis is that of the mean wind,
/// north without wind; it does not turn with the vehicle. A vehicle at rest in still air is still passed by
/// the pattern at kSlowestPassage. No angular turbulence.
class Turbulence {
 public:
  static constexpr double kSlowestPassage = 1.0;  ///< m/s

  /// @param mean_wind_N  m/s
  Turbulence(const TurbulenceParams& params, const Vector3& mean_wind_N, std::uint64_t seed);

  /// Moves on by `dt`, s, >= 0.
  /// @param height    above the ground, m
  /// @param airspeed  of the vehicle against the mean wind, m/s
  void advance(double dt, double height, double airspeed);

  /// m/s.
  const Vector3& wind_N() const { return wind_N_; }

 private:
  /// Two states of the filter (1 + sqrt(3) T s)/(1 + T s)^2 with unit variance at its output.
  struct SecondOrder {
    double u = 0.0;
    double v = 0.0;
    void start(Stream& stream);
    /// @param h  step in units of T
    void advance(double h, Stream& stream);
    double output() const;
  };

  void advance_longitudinal(double h);

  double wind_at_20_feet_;
  double cos_direction_ = 1.0;
  double sin_direction_ = 0.0;
  Stream along_noise_;
  Stream across_noise_;
  Stream vertical_noise_;
  double along_ = 0.0;
  SecondOrder across_;
  SecondOrder vertical_;
  Vector3 wind_N_ = Vector3::Zero();
};

}  // namespace ironbird::simulator
