#include "simulator/vehicle/rotor.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {

using std::numbers::pi;

Rotor::Rotor(const RotorParams& params)
    : params_(params),
      inflow_factor_(2.0 * pi / params.diameter),
      thrust_factor_(std::pow(params.diameter, 4) / (4.0 * pi * pi)),
      torque_factor_(std::pow(params.diameter, 5) / (4.0 * pi * pi)),
      conductance_(1.0 / params.resistance) {}

double Rotor::balance_speed(double voltage, double inflow, double air_density) const {
  // Q(w) = K_V ((voltage - K_V w)/R - i_0) is a w^2 + b w + c = 0.
  const double torque_scale = torque_factor_ * air_density;
  const double a = params_.CQ[0] * torque_scale;
  const double b = params_.CQ[1] * torque_scale * inflow + params_.K_V * params_.K_V * conductance_;
  const double c = params_.CQ[2] * torque_scale * inflow * inflow -
                   params_.K_V * (voltage * conductance_ - params_.no_load_current);
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant <= 0.0) return kLeastSpeed;
  return std::max((std::sqrt(discriminant) - b) / (2.0 * a), kLeastSpeed);
}

}  // namespace ironbird::simulator
