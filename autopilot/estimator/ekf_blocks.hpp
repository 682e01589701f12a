#pragma once

#include "autopilot/estimator/ekf_state.hpp"

namespace ironbird::autopilot {

// Where the blocks of EkfState begin, by the symbols of the paper. For the sources of the filter.

inline constexpr int kP = EkfState::kPosition;
inline constexpr int kDown = EkfState::kPosition + 2;
inline constexpr int kV = EkfState::kVelocity;
inline constexpr int kT = EkfState::kAttitude;
inline constexpr int kPitch = EkfState::kAttitude + 1;
inline constexpr int kHeading = EkfState::kHeading;
inline constexpr int kB = EkfState::kGyroBias;

}  // namespace ironbird::autopilot
