#pragma once

#include "autopilot/estimator/error_state.hpp"

namespace ironbird::autopilot {

// Where the blocks of ErrorState begin: d for the error of the state that the second letter stands for. For
// the sources of the filter.

inline constexpr int kDp = ErrorState::kPosition;
inline constexpr int kDdown = ErrorState::kPosition + 2;
inline constexpr int kDv = ErrorState::kVelocity;
inline constexpr int kDq = ErrorState::kAttitude;
inline constexpr int kDg = ErrorState::kGyroBias;
inline constexpr int kDe = ErrorState::kGyroMisalignment;
inline constexpr int kDs = ErrorState::kGyroScale;
inline constexpr int kDa = ErrorState::kAccelerometerBias;
inline constexpr int kDw = ErrorState::kGnssWalk;
inline constexpr int kDb = ErrorState::kBaroWalk;
inline constexpr int kDm = ErrorState::kMagBias;

}  // namespace ironbird::autopilot
