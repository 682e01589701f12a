#include "scenarios/requirements/number_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "scenarios/config/degrees.hpp"

namespace ironbird::scenarios {

std::string short_number(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0.0 ? "infinity" : "-infinity";
  std::array<char, 32> text{};
  const bool is_long_integer = std::abs(value) >= 1e3 && std::abs(value) < 1e7;
  std::snprintf(text.data(), text.size(), is_long_integer ? "%.0f" : "%.4g", value == 0.0 ? 0.0 : value);
  return text.data();
}

std::string with_unit(double value, std::string_view unit, Angles angles) {
  const bool in_degrees = angles == Angles::kDegrees;
  if (unit == "rad" && in_degrees) return short_number(value * kDegreesPerRadian) + " deg";
  if (unit == "rad/s" && in_degrees) return short_number(value * kDegreesPerRadian) + " deg/s";
  if (unit.empty() || unit == "1" || unit == "SI") return short_number(value);
  return short_number(value) + " " + std::string(unit);
}

}  // namespace ironbird::scenarios
