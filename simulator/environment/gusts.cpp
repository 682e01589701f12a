#include "simulator/environment/gusts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ironbird::simulator {

Gusts::Gusts(const GustParams& params, const Vector3& mean_wind_N, std::uint64_t seed)
    : params_(params),
      direction_N_(mean_wind_N.stableNormalized()),
      arrivals_(seed, "environment/gusts/arrivals"),
      shapes_(seed, "environment/gusts/shapes"),
      active_(params.amplitude != 0.0 || params.amplitude_spread > 0.0) {
  if (active_) next_ = -params_.mean_interval * std::log(arrivals_.uniform());
}

void Gusts::advance(double dt) {
  if (!active_) return;
  now_ += dt;
  while (next_ <= now_) {
    begin_gust(next_);
    next_ -= params_.mean_interval * std::log(arrivals_.uniform());
  }
  wind_N_.setZero();
  for (Gust& gust : gusts_) {
    const double age = now_ - gust.begin;
    if (age >= gust.duration) {
      gust.duration = 0.0;
      continue;
    }
    wind_N_ += 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * age / gust.duration)) * gust.peak_N;
  }
}

void Gusts::begin_gust(double begin) {
  // Every gust takes the same five numbers from the stream, whether it finds a place or not.
  const double peak = params_.amplitude + params_.amplitude_spread * shapes_.normal();
  const Vector3 scatter{shapes_.normal(), shapes_.normal(), shapes_.normal()};
  const double duration = shapes_.uniform(params_.shortest, params_.longest);
  const bool has_direction = direction_N_.squaredNorm() > 0.0;
  const double spread = has_direction ? params_.direction_spread : 1.0;
  const Vector3 towards_N = (direction_N_ + spread * scatter).stableNormalized();

  const auto place =
      std::find_if(gusts_.begin(), gusts_.end(), [](const Gust& gust) { return gust.duration == 0.0; });
  if (place == gusts_.end()) return;
  *place = Gust{begin, duration, peak * towards_N};
}

}  // namespace ironbird::simulator
