#pragma once

#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// A number with its unit for human eyes, four digits: `0.0431 m`, `-20 m`; radians are shown in degrees.
std::string with_unit(double value, std::string_view unit);

/// A number with at most four significant digits; `-` for what is no number.
std::string short_number(double value);

}  // namespace ironbird::scenarios
