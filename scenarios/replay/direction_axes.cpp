#include "scenarios/replay/direction_axes.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace ironbird::scenarios {

namespace {

using autopilot::Matrix3;
using autopilot::Vector3;

/// A word and the axis of ours along which it points: 1, 2, 3, negative for against it.
using Direction = std::pair<std::string_view, int>;
using Directions = std::array<Direction, 6>;

constexpr Directions kBody{{{"front", 1}, {"back", -1}, {"right", 2}, {"left", -2}, {"down", 3}, {"up", -3}}};
constexpr Directions kNorth{
    {{"north", 1}, {"south", -1}, {"east", 2}, {"west", -2}, {"down", 3}, {"up", -3}}};

Vector3 direction_of(std::string_view word, const Directions& known) {
  for (const auto& [name, axis] : known) {
    if (name == word) return (axis > 0 ? 1.0 : -1.0) * Vector3::Unit(std::abs(axis) - 1);
  }
  std::string names;
  for (const auto& [name, axis] : known) names += (names.empty() ? "" : ", ") + std::string(name);
  throw AxesError("'" + std::string(word) + "' is no direction; there are " + names);
}

Matrix3 from_axes(const std::string& text, const Directions& known, const char* example) {
  const std::string must = std::string("must be three directions at right angles, such as ") + example;
  Matrix3 axes = Matrix3::Zero();
  std::string_view rest = text;
  for (int k = 0; k < 3; ++k) {
    const std::size_t dash = rest.find('-');
    const bool is_last = k == 2;
    if ((dash == std::string_view::npos) != is_last) throw AxesError(must);
    axes.col(k) = direction_of(rest.substr(0, dash), known);
    if (!is_last) rest.remove_prefix(dash + 1);
  }
  const double determinant = axes.determinant();
  if (determinant == 0.0) throw AxesError(must);
  if (determinant < 0.0) throw AxesError("is left-handed; turn one of the three round");
  return axes;
}

}  // namespace

Matrix3 body_from_axes(const std::string& text) {
  return from_axes(text, kBody, "front-left-up");
}

Matrix3 north_from_axes(const std::string& text) {
  return from_axes(text, kNorth, "east-north-up");
}

}  // namespace ironbird::scenarios
