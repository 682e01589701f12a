#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace ironbird::scenarios {

/// What people count angles in: degrees, except of a rotor, whose speed is written and shown in rad/s.
enum class Angles : std::uint8_t { kDegrees, kRadians };

constexpr std::array<std::pair<Angles, std::string_view>, 2> enumerators(Angles) {
  return {{{Angles::kDegrees, "degrees"}, {Angles::kRadians, "radians"}}};
}

/// A number with its unit for human eyes, four digits: `0.0431 m`, `-20 m`; radians are shown in `angles`.
std::string with_unit(double value, std::string_view unit, Angles angles = Angles::kDegrees);

/// A number with at most four significant digits; `-` for what is no number.
std::string short_number(double value);

}  // namespace ironbird::scenarios
