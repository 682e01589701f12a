#pragma once

#include <numbers>

namespace ironbird::scenarios {

/// In a radian.
inline constexpr double kDegrees = 180.0 / std::numbers::pi;

}  // namespace ironbird::scenarios
