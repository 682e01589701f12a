#pragma once

#include <numbers>

namespace ironbird::scenarios {

/// Degrees in a radian.
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace ironbird::scenarios
