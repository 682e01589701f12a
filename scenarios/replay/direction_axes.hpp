#pragma once

#include <stdexcept>
#include <string>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::scenarios {

/// What is no set of three axes, and what would be one.
class AxesError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The rotation from a recorder's axes to B. @param text  where its axes point, in order, joined by `-`:
/// `front-left-up`; of front, back, left, right, up, down
/// @throws AxesError when these are not three right-handed axes
autopilot::Matrix3 body_from_axes(const std::string& text);

/// The rotation from a recorder's axes to N. @param text  `east-north-up`; of north, south, east, west, up,
/// down @throws AxesError when these are not three right-handed axes
autopilot::Matrix3 north_from_axes(const std::string& text);

}  // namespace ironbird::scenarios
