#include "hil_bridge/virtual_fcu/physical_mixer.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "hil_bridge/virtual_fcu/command.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr double kFourPiSquared = 4.0 * std::numbers::pi * std::numbers::pi;

}  // namespace

double MixerPropeller::thrust_factor() const {
  return density * diameter * diameter * diameter * diameter * CT / kFourPiSquared;
}

double MixerPropeller::torque_factor() const {
  return density * diameter * diameter * diameter * diameter * diameter * CQ / kFourPiSquared;
}

std::array<std::array<double, kMixerOutputs>, kMixerInputs> physical_mixer(std::span<const MixerRotor> rotors,
                                                                           const MixerPropeller& propeller) {
  const std::size_t count = std::min(rotors.size(), static_cast<std::size_t>(kMixerOutputs));
  const double k_T = propeller.thrust_factor();
  const double k_Q = propeller.torque_factor();
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, kMixerOutputs> effect(4, static_cast<Eigen::Index>(count));
  for (std::size_t j = 0; j < count; ++j) {
    effect.col(static_cast<Eigen::Index>(j)) << -k_T, -rotors[j].y * k_T, rotors[j].x * k_T,
        rotors[j].torque_sign * k_Q;
  }
  // The rows differ by orders of magnitude: each is scaled to its unit before the rank is judged.
  const Eigen::Vector4d scale = {k_T, k_T, k_T, k_Q};
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * effect;
  const Eigen::MatrixXd inverse = scaled.completeOrthogonalDecomposition().pseudoInverse();
  std::array<std::array<double, kMixerOutputs>, kMixerInputs> mixer{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t j = 0; j < count; ++j) {
      const auto i = static_cast<Eigen::Index>(row);
      mixer[kForceZ + row][j] = inverse(static_cast<Eigen::Index>(j), i) / scale(i);
    }
  }
  return mixer;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
