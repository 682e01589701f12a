#include "simulator/environment/environment.hpp"

#include <cmath>
#include <stdexcept>

#include "simulator/random/stream.hpp"
#include "simulator/types/bounds.hpp"

namespace ironbird::simulator {
namespace {

EnvironmentParams checked(const EnvironmentParams& params) {
  check_bounds(params, "environment");
  if (params.wind.gusts.shortest > params.wind.gusts.longest) {
    throw std::invalid_argument(
        "environment.wind.gusts.shortest = " + std::to_string(params.wind.gusts.shortest) +
        " s, must not exceed environment.wind.gusts.longest = " + std::to_string(params.wind.gusts.longest) +
        " s");
  }
  return params;
}

Vector3 mean_wind(const WindParams& wind, std::uint64_t seed) {
  Stream stream(seed, "environment/wind/spread");
  const Vector3 draw{stream.normal(), stream.normal(), stream.normal()};
  return wind.steady_N + wind.spread_N.cwiseProduct(draw);
}

Vector3 field(const MagneticFieldParams& params) {
  const double horizontal = params.strength * std::cos(params.inclination);
  return {horizontal * std::cos(params.declination), horizontal * std::sin(params.declination),
          params.strength * std::sin(params.inclination)};
}

}  // namespace

Environment::Environment(const EnvironmentParams& params, std::uint64_t seed)
    : params_(checked(params)),
      air_(params.air, params.home.altitude),
      gusts_(params.wind.gusts, mean_wind(params.wind, seed), seed),
      turbulence_(params.wind.turbulence, mean_wind(params.wind, seed), seed),
      magnetic_field_N_(field(params.magnetic_field)),
      mean_wind_N_(mean_wind(params.wind, seed)),
      wind_N_(mean_wind_N_) {}

void Environment::advance(double dt, const Vector3& p_NB_N, const Vector3& v_NB_N) {
  gusts_.advance(dt);
  turbulence_.advance(dt, -p_NB_N.z(), (v_NB_N - mean_wind_N_).norm());
  wind_N_ = mean_wind_N_ + gusts_.wind_N() + turbulence_.wind_N();
}

void Environment::add_wind(const Vector3& wind_N) {
  mean_wind_N_ += wind_N;
  wind_N_ += wind_N;
}

}  // namespace ironbird::simulator
