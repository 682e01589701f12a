#include "scenarios/requirements/quantity_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ironbird::scenarios {

namespace {

struct Unit {
  std::string_view name;
  std::string_view si;
  double factor;
};

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::array<Unit, 14> kUnits{{{"deg", "rad", kDegree},
                                       {"deg/s", "rad/s", kDegree},
                                       {"mm", "m", 1e-3},
                                       {"cm", "m", 1e-2},
                                       {"km", "m", 1e3},
                                       {"cm/s", "m/s", 1e-2},
                                       {"km/h", "m/s", 1.0 / 3.6},
                                       {"ms", "s", 1e-3},
                                       {"us", "s", 1e-6},
                                       {"min", "s", 60.0},
                                       {"%", "1", 1e-2},
                                       {"rpm", "rad/s", 2.0 * std::numbers::pi / 60.0},
                                       {"hPa", "Pa", 1e2},
                                       {"mV", "V", 1e-3}}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

double read_quantity(std::string_view text, std::string_view unit, const std::string& what) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) {
    throw std::invalid_argument(what + " = \"" + std::string(text) + "\", must be a number" +
                                (unit.empty() ? "" : " in " + std::string(unit)));
  }
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  rest = trimmed(rest);
  if (rest.empty() || rest == unit) return number;
  for (const Unit& known : kUnits) {
    if (known.name == rest && known.si == unit) return number * known.factor;
  }
  throw std::invalid_argument(what + " = \"" + std::string(text) + "\", must be in " +
                              (unit.empty() ? "1" : std::string(unit)));
}

}  // namespace ironbird::scenarios
