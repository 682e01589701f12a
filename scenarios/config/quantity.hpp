#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace ironbird::scenarios {

/// A unit of measurement: powers of the base units and a factor to them.
///
/// The plane angle counts as a base unit, so that rad/s and Hz are different things.
struct Unit {
  enum Base : std::size_t { kMetre, kKilogram, kSecond, kAmpere, kKelvin, kRadian, kBaseCount };

  /// Twice the power of each base unit: square roots occur in noise densities.
  std::array<std::int8_t, kBaseCount> twice_power{};
  /// One of this unit is numerator / denominator in base units. A fraction, so that 9 ms are 0.009 s to the
  /// bit.
  double numerator = 1.0;
  double denominator = 1.0;
  /// Added after the factor: only for a temperature on the Celsius scale, K.
  double offset = 0.0;

  bool same_dimension(const Unit& other) const { return twice_power == other.twice_power; }
};

/// What is wrong with a quantity, and what would be right.
class QuantityError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Reads a unit such as `m/s^2`, `kg*m^2`, `rad/s/sqrt(Hz)`, `hPa`, `1`. The empty text is `1`.
/// @throws QuantityError naming the part that is no unit
Unit parse_unit(std::string_view text);

/// Reads `25 deg`, `400 Hz`, `0.5 ms`, and gives the number in `needed`, a unit as in `describe`. A number
/// alone is in `needed` already. A rate given for a time becomes its period, and the reverse. With `needed`
/// empty any unit goes and the result is in SI units.
/// @throws QuantityError such as "found 'deg', needs m/s or km/h"
double parse_quantity(std::string_view text, std::string_view needed);

}  // namespace ironbird::scenarios
