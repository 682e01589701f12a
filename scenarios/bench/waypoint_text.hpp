#pragma once

#include <cstddef>
#include <string>

#include "autopilot/types/mission.hpp"

namespace ironbird::scenarios {

/// One line about a waypoint, for people: `1: hold at (-20.00, 0.50, -8.00) m, heading 90.00 deg, for 10.00
/// s`.
/// @param index  its place in the route, from 0
std::string line_about(const autopilot::Waypoint& waypoint, std::size_t index);

}  // namespace ironbird::scenarios
