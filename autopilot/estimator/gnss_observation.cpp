#include "autopilot/estimator/gnss_observation.hpp"

#include <algorithm>

namespace ironbird::autopilot {

namespace {

constexpr double kNoHeight = 1.0e3;  // m, sigma of a height without weight

}  // namespace

void weigh(GnssObservation& fix, const GnssSample& gnss, const GnssParams& wanted) {
  const double sigma_vertical = wanted.sigma_vertical.value_or(kNoHeight);
  Vector3 sigma_p(wanted.sigma_horizontal, wanted.sigma_horizontal, sigma_vertical);
  Vector3 sigma_v(wanted.sigma_velocity_horizontal, wanted.sigma_velocity_horizontal,
                  wanted.sigma_velocity_vertical);
  const double gate_sigma = std::min(wanted.sigma_horizontal, wanted.gate_sigma);
  Vector3 gate_sigma_p(gate_sigma, gate_sigma, sigma_vertical);
  if (wanted.use_receiver_accuracy) {
    const double horizontal = gnss.horizontal_accuracy;
    const Vector3 claimed(horizontal, horizontal, gnss.vertical_accuracy);
    sigma_p = sigma_p.cwiseMax(claimed);
    gate_sigma_p = gate_sigma_p.cwiseMax(claimed);
    sigma_v = sigma_v.cwiseMax(gnss.speed_accuracy);
  }
  fix.variance_p = sigma_p.cwiseProduct(sigma_p);
  fix.gate_variance_p = gate_sigma_p.cwiseProduct(gate_sigma_p);
  fix.variance_v = sigma_v.cwiseProduct(sigma_v);
}

}  // namespace ironbird::autopilot
