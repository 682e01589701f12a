#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Ten inputs by ten outputs: element [input][output] multiplies that input for that output.
using MixerMatrix = std::array<std::array<float, kMixerOutputs>, kMixerInputs>;

/// What drives an output; the values are those of PRI_MIXER_OUT_j.
enum class OutputKind : std::uint8_t { kAuxiliary = 0, kServo = 1, kMotor = 2, kGpio = 3 };

// Values of PRIMARY_MIXER and SECONDARY_MIXER with a meaning of their own.
inline constexpr int kEscCalibration = 0;
inline constexpr int kFixedWing = 9;
inline constexpr int kVTail = 10;
inline constexpr int kCustomMixer = 11;
inline constexpr int kMixerIds = 12;  ///< this and above: invalid

/// A mixer that the firmware knows by number.
struct CannedMixer {
  std::string_view name;
  std::array<OutputKind, kMixerOutputs> kinds{};
  std::array<float, kMixerOutputs> rates{};  ///< Hz
  MixerMatrix matrix{};                      ///< effect of each output on each input: before inversion
};

/// @param id  0..10
CannedMixer canned_mixer(int id);

/// Moore-Penrose inverse, transposed back so that it is indexed like its argument; singular values below ten
/// float epsilons of the greatest count as zero, and so do entries of the result below 1e-6.
MixerMatrix inverted(const MixerMatrix& matrix);

}  // namespace ironbird::hil_bridge::virtual_fcu
