#include "simulator/environment/turbulence.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

constexpr double kFoot = 0.3048;  // m
constexpr double kSqrt3 = 1.7320508075688772;

}  // namespace

TurbulenceScale low_altitude_scale(double height, double wind_at_20_feet) {
  const double h = std::clamp(height / kFoot, 10.0, 1000.0);  // ft
  const double k = 0.177 + 0.000823 * h;
  TurbulenceScale scale;
  scale.length_vertical = h * kFoot;
  scale.length_horizontal = h * kFoot / std::pow(k, 1.2);
  scale.sigma_vertical = 0.1 * wind_at_20_feet;
  scale.sigma_horizontal = scale.sigma_vertical / std::pow(k, 0.4);
  return scale;
}

Turbulence::Turbulence(const TurbulenceParams& params, const Vector3& mean_wind_N, std::uint64_t seed)
    : wind_at_20_feet_(params.wind_at_20_feet),
      along_noise_(seed, "environment/turbulence/along"),
      across_noise_(seed, "environment/turbulence/across"),
      vertical_noise_(seed, "environment/turbulence/vertical") {
  const double horizontal = std::hypot(mean_wind_N.x(), mean_wind_N.y());
  if (horizontal > 0.0) {
    cos_direction_ = mean_wind_N.x() / horizontal;
    sin_direction_ = mean_wind_N.y() / horizontal;
  }
  along_ = along_noise_.normal();
  across_.start(across_noise_);
  vertical_.start(vertical_noise_);
}

void Turbulence::advance(double dt, double height, double airspeed) {
  if (wind_at_20_feet_ == 0.0) return;
  const TurbulenceScale scale = low_altitude_scale(height, wind_at_20_feet_);
  const double distance = std::max(airspeed, kSlowestPassage) * dt;
  advance_longitudinal(distance / scale.length_horizontal);
  across_.advance(distance / scale.length_horizontal, across_noise_);
  vertical_.advance(distance / scale.length_vertical, vertical_noise_);

  const double along = scale.sigma_horizontal * along_;
  const double across = scale.sigma_horizontal * across_.output();
  wind_N_ =
      Vector3(cos_direction_ * along - sin_direction_ * across,
              sin_direction_ * along + cos_direction_ * across, scale.sigma_vertical * vertical_.output());
}

void Turbulence::advance_longitudinal(double h) {
  // 1/(1 + T s), unit variance: x -> e^-h x + sqrt(1 - e^-2h) n.
  along_ = std::exp(-h) * along_ + std::sqrt(-std::expm1(-2.0 * h)) * along_noise_.normal();
}

void Turbulence::SecondOrder::start(Stream& stream) {
  // Stationary: var u = 1/2, cov(u, v) = 1/4, var v = 1/4.
  u = std::sqrt(0.5) * stream.normal();
  v = 0.5 * u + std::sqrt(0.125) * stream.normal();
}

void Turbulence::SecondOrder::advance(double h, Stream& stream) {
  // (1 + sqrt(3) s)/(1 + s)^2 = sqrt(3)/(1 + s) + (1 - sqrt(3))/(1 + s)^2 with s in units of 1/T:
  // u' = -u + n, v' = -v + u. Over h the noise adds (xi_1, xi_2) with xi_k = integral of s^(k-1) e^-s n ds.
  const double e = std::exp(-h);
  const double e2 = e * e;
  const double var_1 = -0.5 * std::expm1(-2.0 * h);
  const double covariance = 0.25 * (1.0 - e2 * (1.0 + 2.0 * h));
  const double var_2 = 0.25 * (1.0 - e2 * (1.0 + 2.0 * h + 2.0 * h * h));
  // For small h the difference below cancels to (h^3/12)(1 - h + 7 h^2/15).
  constexpr double kSeriesBelow = 0.01;
  const double rest = h < kSeriesBelow ? h * h * h / 12.0 * (1.0 - h + 7.0 / 15.0 * h * h)
                                       : var_2 - covariance * covariance / var_1;
  const double n_1 = stream.normal();
  const double n_2 = stream.normal();
  const double xi_1 = std::sqrt(var_1) * n_1;
  const double slope = h > 0.0 ? covariance / std::sqrt(var_1) : 0.0;
  const double xi_2 = slope * n_1 + std::sqrt(std::max(rest, 0.0)) * n_2;
  v = e * (v + h * u) + xi_2;
  u = e * u + xi_1;
}

double Turbulence::SecondOrder::output() const {
  return kSqrt3 * u + (1.0 - kSqrt3) * v;
}

}  // namespace ironbird::simulator
