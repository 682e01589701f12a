#pragma once

#include <cstdint>

#include "simulator/environment/air.hpp"
#include "simulator/environment/gusts.hpp"
#include "simulator/environment/turbulence.hpp"
#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// Where the local origin lies on the earth.
struct HomeParams {
  double latitude = 0.7024317104;    ///< rad, north positive
  double longitude = -1.9486149720;  ///< rad, east positive
  double altitude = 1387.0;          ///< m above mean sea level

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("latitude", self.latitude, "rad", "geodetic latitude, north positive; no pole", -1.57, 1.57);
    visit("longitude", self.longitude, "rad", "longitude, east positive", -3.1415926535897931,
          3.1415926535897931);
    visit("altitude", self.altitude, "m", "height above mean sea level", -500.0, 9000.0);
  }
};

/// The earth's magnetic field at the origin, the same everywhere.
struct MagneticFieldParams {
  double strength = 50.7163e-6;       ///< T
  double inclination = 1.139436457;   ///< rad, down positive
  double declination = 0.1857972802;  ///< rad, east positive

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("strength", self.strength, "T", "magnitude of the field", 0.0, 1e-3);
    visit("inclination", self.inclination, "rad", "angle below the horizon", -1.5707963267948966,
          1.5707963267948966);
    visit("declination", self.declination, "rad", "angle east of true north", -3.1415926535897931,
          3.1415926535897931);
  }
};

/// What moves the air. All parts add up; each random part has its own stream.
struct WindParams {
  Vector3 steady_N = Vector3::Zero();
  Vector3 spread_N = Vector3::Zero();
  GustParams gusts;
  TurbulenceParams turbulence;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("steady_N", self.steady_N, "m/s", "velocity of the air that never changes", -100.0, 100.0);
    visit("spread_N", self.spread_N, "m/s",
          "standard deviation, per axis, of a further constant wind that is drawn once per run", 0.0, 100.0);
    visit("gusts", self.gusts, "", "single gusts");
    visit("turbulence", self.turbulence, "", "continuous turbulence");
  }
};

/// Everything around the vehicle except the things it can touch.
struct EnvironmentParams {
  HomeParams home;
  double gravity = 9.80665;
  MagneticFieldParams magnetic_field;
  AirParams air;
  WindParams wind;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("home", self.home, "", "the local origin on the earth");
    visit("gravity", self.gravity, "m/s^2", "along +Nz", 0.0, 20.0);
    visit("magnetic_field", self.magnetic_field, "", "the earth's field");
    visit("air", self.air, "", "pressure, temperature and density");
    visit("wind", self.wind, "", "what moves the air");
  }
};

/// Air, wind, gravity and magnetic field around one vehicle.
///
/// Heights are above the local origin. Gravity and the magnetic field do not change over the flight's extent.
/// The wind is that at the vehicle; it is held from one `advance` to the next and does not vary over the
/// vehicle's size.
class Environment {
 public:
  /// @param seed  of the run; the streams are named "environment/..."
  /// @throws std::invalid_argument when a parameter is outside its bounds
  Environment(const EnvironmentParams& params, std::uint64_t seed);

  /// Moves gusts and turbulence on by `dt`. Called before the plant's step, whose wind it sets.
  /// @param dt      s, >= 0
  /// @param p_NB_N  where the vehicle is, m
  /// @param v_NB_N  how fast it moves, m/s: turbulence is a frozen pattern that it flies through
  void advance(double dt, const Vector3& p_NB_N, const Vector3& v_NB_N);

  /// Velocity of the air at the vehicle, m/s.
  const Vector3& wind_N() const { return wind_N_; }

  /// Adds to the steady wind from now on, m/s. Taken back by adding the opposite.
  void add_wind(const Vector3& wind_N);

  /// kg/m^3.
  double air_density(double altitude_above_home) const { return air_.density(altitude_above_home); }
  /// Density and its change with height.
  DensityProfile air_density_profile(double altitude_above_home) const {
    return air_.density_profile(altitude_above_home);
  }
  /// Static pressure, Pa.
  double pressure(double altitude_above_home) const { return air_.pressure(altitude_above_home); }
  /// K.
  double temperature(double altitude_above_home) const { return air_.temperature(altitude_above_home); }

  /// m/s^2, along +Nz.
  double gravity() const { return params_.gravity; }
  /// T.
  const Vector3& magnetic_field_N() const { return magnetic_field_N_; }

  /// Of the local origin: rad, rad, m above mean sea level.
  double latitude() const { return params_.home.latitude; }
  double longitude() const { return params_.home.longitude; }
  double altitude() const { return params_.home.altitude; }

  const EnvironmentParams& params() const { return params_; }

 private:
  EnvironmentParams params_;
  Air air_;
  Gusts gusts_;
  Turbulence turbulence_;
  Vector3 magnetic_field_N_;
  Vector3 mean_wind_N_;
  Vector3 wind_N_;
};

}  // namespace ironbird::simulator
