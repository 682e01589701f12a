#include "hil_bridge/virtual_fcu/canned_mixers.hpp"

#include <Eigen/Dense>
#include <cassert>
#include <cmath>
#include <limits>

#include "hil_bridge/virtual_fcu/command.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

namespace {

constexpr float kMotorRate = 490.0F;  // Hz
constexpr float kSlowRate = 50.0F;    // Hz

/// Directions of the rotors of a multirotor, motor by motor.
struct Rotors {
  std::string_view name;
  int count;
  float share;  // of the force along Bz
  std::array<float, 8> roll;
  std::array<float, 8> pitch;
};

constexpr std::array<Rotors, 8> kMultirotors = {{
    {"quad +", 4, -0.25F, {0, -1, 0, 1}, {1, 0, -1, 0}},
    {"quad x", 4, -0.25F, {-.7071F, -.7071F, .7071F, .7071F}, {.7071F, -.7071F, -.7071F, .7071F}},
    {"hex +", 6, -0.1667F, {0, -.866F, -.866F, 0, .866F, .866F}, {1, .5F, -.5F, -1, -.5F, .5F}},
    {"hex x", 6, -0.1667F, {-.5F, -1, -.5F, .5F, 1, .5F}, {.866F, 0, -.866F, -.866F, 0, .866F}},
    {"octo +",
     8,
     -0.125F,
     {0, -.7071F, -1, -.7071F, 0, .7071F, 1, .7071F},
     {1, .7071F, 0, -.7071F, -1, -.7071F, 0, .7071F}},
    {"octo x",
     8,
     -0.125F,
     {-.3827F, -.9239F, -.9239F, -.3827F, .3827F, .9239F, .9239F, .3827F},
     {.9239F, .3827F, -.3827F, -.9239F, -.9239F, -.3827F, .3827F, .9239F}},
    {"Y6", 6, -0.1667F, {-.866F, -.866F, 0, 0, .866F, .866F}, {.5F, .5F, -1, -1, .5F, .5F}},
    {"X8",
     8,
     -0.125F,
     {-.7071F, -.7071F, -.7071F, -.7071F, .7071F, .7071F, .7071F, .7071F},
     {.7071F, .7071F, -.7071F, -.7071F, -.7071F, -.7071F, .7071F, .7071F}},
}};

CannedMixer multirotor(const Rotors& rotors) {
  CannedMixer mixer{.name = rotors.name};
  mixer.rates.fill(kSlowRate);
  for (std::size_t j = 0; j < static_cast<std::size_t>(rotors.count); ++j) {
    mixer.kinds[j] = OutputKind::kMotor;
    mixer.rates[j] = kMotorRate;
    mixer.matrix[kForceZ][j] = rotors.share;
    mixer.matrix[kRoll][j] = rotors.roll[j];
    mixer.matrix[kPitch][j] = rotors.pitch[j];
    mixer.matrix[kYaw][j] = j % 2 == 0 ? 1.0F : -1.0F;
  }
  return mixer;
}

CannedMixer esc_calibration() {
  CannedMixer mixer{.name = "ESC calibration"};
  mixer.kinds.fill(OutputKind::kMotor);
  mixer.rates.fill(kSlowRate);
  mixer.matrix[kForceZ].fill(0.1F);
  return mixer;
}

CannedMixer wing(std::string_view name) {
  CannedMixer mixer{.name = name};
  mixer.kinds[0] = mixer.kinds[1] = mixer.kinds[2] = OutputKind::kServo;
  mixer.kinds[4] = OutputKind::kMotor;
  mixer.rates.fill(kSlowRate);
  mixer.matrix[kForceX][4] = 1.0F;
  mixer.matrix[kRoll][0] = 1.0F;
  return mixer;
}

CannedMixer fixed_wing() {
  CannedMixer mixer = wing("fixed wing");
  mixer.matrix[kPitch][1] = 1.0F;
  mixer.matrix[kYaw][2] = 1.0F;
  return mixer;
}

CannedMixer v_tail() {
  CannedMixer mixer = wing("inverted V-tail");
  mixer.matrix[kPitch][1] = -0.5F;
  mixer.matrix[kPitch][2] = 0.5F;
  mixer.matrix[kYaw][1] = 0.5F;
  mixer.matrix[kYaw][2] = 0.5F;
  return mixer;
}

}  // namespace

CannedMixer canned_mixer(int id) {
  assert(id >= kEscCalibration && id < kCustomMixer);
  if (id == kEscCalibration) return esc_calibration();
  if (id == kFixedWing) return fixed_wing();
  if (id == kVTail) return v_tail();
  return multirotor(kMultirotors[static_cast<std::size_t>(id - 1)]);
}

MixerMatrix inverted(const MixerMatrix& matrix) {
  using Matrix = Eigen::Matrix<float, kMixerInputs, kMixerOutputs>;
  constexpr float kRelativeThreshold = 10.0F * std::numeric_limits<float>::epsilon();
  constexpr float kLeastEntry = 1e-6F;
  Matrix effect;
  for (int i = 0; i < kMixerInputs; ++i) {
    for (int j = 0; j < kMixerOutputs; ++j) effect(i, j) = matrix[i][j];
  }
  const Eigen::JacobiSVD<Matrix> svd(effect, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix<float, kMixerInputs, 1> sigma = svd.singularValues();
  Eigen::Matrix<float, kMixerInputs, 1> inverse_sigma = Eigen::Matrix<float, kMixerInputs, 1>::Zero();
  for (int k = 0; k < kMixerInputs; ++k) {
    if (sigma(k) > kRelativeThreshold * sigma(0)) inverse_sigma(k) = 1.0F / sigma(k);
  }
  const Matrix inverse = svd.matrixV() * inverse_sigma.asDiagonal() * svd.matrixU().transpose();
  MixerMatrix result{};
  for (int i = 0; i < kMixerInputs; ++i) {
    for (int j = 0; j < kMixerOutputs; ++j) {
      result[i][j] = std::fabs(inverse(j, i)) < kLeastEntry ? 0.0F : inverse(j, i);
    }
  }
  return result;
}

}  // namespace ironbird::hil_bridge::virtual_fcu
