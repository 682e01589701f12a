#include "scenarios/config/quantity.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace ironbird::scenarios {
namespace {

struct NamedUnit {
  std::string_view name;
  bool takes_prefix;
  /// Powers of m, kg, s, A, K, rad.
  std::array<int, Unit::kBaseCount> power;
  double numerator;
  double denominator;
  double offset = 0.0;
};

constexpr double kPi = std::numbers::pi;
constexpr int kGreatestPower = 100;  // doubled

constexpr std::array<NamedUnit, 33> kUnits{{
    {"1", false, {0, 0, 0, 0, 0, 0}, 1, 1},
    {"%", false, {0, 0, 0, 0, 0, 0}, 1, 100},
    {"m", true, {1, 0, 0, 0, 0, 0}, 1, 1},
    {"kg", false, {0, 1, 0, 0, 0, 0}, 1, 1},
    {"g", true, {0, 1, 0, 0, 0, 0}, 1, 1000},
    {"s", true, {0, 0, 1, 0, 0, 0}, 1, 1},
    {"min", false, {0, 0, 1, 0, 0, 0}, 60, 1},
    {"h", false, {0, 0, 1, 0, 0, 0}, 3600, 1},
    {"A", true, {0, 0, 0, 1, 0, 0}, 1, 1},
    {"K", true, {0, 0, 0, 0, 1, 0}, 1, 1},
    {"degC", false, {0, 0, 0, 0, 1, 0}, 1, 1, 273.15},
    {"rad", true, {0, 0, 0, 0, 0, 1}, 1, 1},
    {"deg", false, {0, 0, 0, 0, 0, 1}, kPi, 180},
    {"rev", false, {0, 0, 0, 0, 0, 1}, 2 * kPi, 1},
    {"rpm", false, {0, 0, -1, 0, 0, 1}, 2 * kPi, 60},
    {"Hz", true, {0, 0, -1, 0, 0, 0}, 1, 1},
    {"N", true, {1, 1, -2, 0, 0, 0}, 1, 1},
    {"Pa", true, {-1, 1, -2, 0, 0, 0}, 1, 1},
    {"bar", true, {-1, 1, -2, 0, 0, 0}, 100000, 1},
    {"J", true, {2, 1, -2, 0, 0, 0}, 1, 1},
    {"W", true, {2, 1, -3, 0, 0, 0}, 1, 1},
    {"Wh", true, {2, 1, -2, 0, 0, 0}, 3600, 1},
    {"C", true, {0, 0, 1, 1, 0, 0}, 1, 1},
    {"Ah", true, {0, 0, 1, 1, 0, 0}, 3600, 1},
    {"V", true, {2, 1, -3, -1, 0, 0}, 1, 1},
    {"Ohm", true, {2, 1, -3, -2, 0, 0}, 1, 1},
    {"ohm", true, {2, 1, -3, -2, 0, 0}, 1, 1},
    {"F", true, {-2, -1, 4, 2, 0, 0}, 1, 1},
    {"H", true, {2, 1, -2, -2, 0, 0}, 1, 1},
    {"Wb", true, {2, 1, -2, -1, 0, 0}, 1, 1},
    {"T", true, {0, 1, -2, -1, 0, 0}, 1, 1},
    {"gauss", true, {0, 1, -2, -1, 0, 0}, 1, 10000},
    {"kV_rpm", false, {-2, -1, 2, 1, 0, 1}, 2 * kPi, 60},
}};

struct Prefix {
  char letter;
  double numerator;
  double denominator;
};

constexpr std::array<Prefix, 9> kPrefixes{{{'p', 1, 1e12},
                                           {'n', 1, 1e9},
                                           {'u', 1, 1e6},
                                           {'m', 1, 1e3},
                                           {'c', 1, 1e2},
                                           {'d', 1, 1e1},
                                           {'h', 1e2, 1},
                                           {'k', 1e3, 1},
                                           {'M', 1e6, 1}}};

const NamedUnit* find_unit(std::string_view name) {
  for (const NamedUnit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

Unit to_unit(const NamedUnit& named) {
  Unit unit;
  for (std::size_t i = 0; i < Unit::kBaseCount; ++i) {
    unit.twice_power[i] = static_cast<std::int8_t>(2 * named.power[i]);
  }
  unit.numerator = named.numerator;
  unit.denominator = named.denominator;
  unit.offset = named.offset;
  return unit;
}

Unit unit_by_name(std::string_view name) {
  if (const NamedUnit* named = find_unit(name)) return to_unit(*named);
  for (const Prefix& prefix : kPrefixes) {
    if (name.size() < 2 || name[0] != prefix.letter) continue;
    const NamedUnit* named = find_unit(name.substr(1));
    if (named == nullptr || !named->takes_prefix) continue;
    Unit unit = to_unit(*named);
    unit.numerator *= prefix.numerator;
    unit.denominator *= prefix.denominator;
    return unit;
  }
  throw QuantityError("'" + std::string(name) + "' is no unit");
}

/// `unit` to the power of half of `twice`.
Unit raised(const Unit& unit, int twice) {
  Unit result;
  for (std::size_t i = 0; i < Unit::kBaseCount; ++i) {
    const int product = unit.twice_power[i] * twice;
    if (product % 2 != 0 || std::abs(product / 2) > kGreatestPower)
      throw QuantityError("a power that no unit has");
    result.twice_power[i] = static_cast<std::int8_t>(product / 2);
  }
  const bool inverted = twice < 0;
  const double power = std::abs(twice) * 0.5;
  const double numerator = twice == 2 || twice == -2 ? unit.numerator : std::pow(unit.numerator, power);
  const double denominator = twice == 2 || twice == -2 ? unit.denominator : std::pow(unit.denominator, power);
  result.numerator = inverted ? denominator : numerator;
  result.denominator = inverted ? numerator : denominator;
  return result;
}

Unit product(const Unit& a, const Unit& b) {
  Unit result;
  for (std::size_t i = 0; i < Unit::kBaseCount; ++i) {
    const int sum = a.twice_power[i] + b.twice_power[i];
    if (std::abs(sum) > kGreatestPower) throw QuantityError("a power that no unit has");
    result.twice_power[i] = static_cast<std::int8_t>(sum);
  }
  result.numerator = a.numerator * b.numerator;
  result.denominator = a.denominator * b.denominator;
  return result;
}

/// Reads: unit = power { (* | /) power };  power = factor [^ number];  factor = name | ( unit ) | sqrt( unit
/// ).
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : rest_(text) {}

  Unit whole() {
    const Unit unit = parse_product();
    if (!rest_.empty()) throw QuantityError("'" + std::string(rest_) + "' is left over");
    return unit;
  }

 private:
  char next() {
    while (rest_.starts_with(' ')) rest_.remove_prefix(1);
    return rest_.empty() ? '\0' : rest_.front();
  }

  Unit parse_product() {
    Unit unit = parse_power();
    while (next() == '*' || next() == '/') {
      const int twice = next() == '*' ? 2 : -2;
      rest_.remove_prefix(1);
      unit = product(unit, raised(parse_power(), twice));
    }
    return unit;
  }

  Unit parse_power() {
    const Unit unit = parse_factor();
    if (next() != '^') return unit;
    rest_.remove_prefix(1);
    double exponent = 0.0;
    const auto result = std::from_chars(rest_.data(), rest_.data() + rest_.size(), exponent);
    const double twice = 2.0 * exponent;
    if (result.ec != std::errc() || std::abs(twice) > 20.0 || twice != std::round(twice)) {
      throw QuantityError("'" + std::string(rest_) + "' is no power");
    }
    rest_.remove_prefix(static_cast<std::size_t>(result.ptr - rest_.data()));
    return raised(unit, static_cast<int>(twice));
  }

  Unit parse_factor() {
    if (next() == '(') return parse_group();
    const std::string_view name = rest_.substr(0, rest_.find_first_of(" */^()"));
    rest_.remove_prefix(name.size());
    if (name == "sqrt" && next() == '(') return raised(parse_group(), 1);
    return unit_by_name(name);
  }

  Unit parse_group() {
    if (++depth_ > 8) throw QuantityError("too many parentheses");
    rest_.remove_prefix(1);
    const Unit unit = parse_product();
    if (next() != ')') throw QuantityError("')' is missing");
    rest_.remove_prefix(1);
    --depth_;
    return unit;
  }

  std::string_view rest_;
  int depth_ = 0;
};

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// What people write, as the units that a message offers beside the one that is declared.
constexpr std::string_view kUsual[] = {
    "m",   "mm",  "cm",    "km",    "m/s", "km/h", "kg", "g",   "s",   "ms",  "us",   "min",
    "h",   "Hz",  "kHz",   "A",     "mA",  "A*s",  "C",  "mAh", "Ah",  "K",   "degC", "rad",
    "deg", "rev", "rad/s", "deg/s", "rpm", "N",    "Pa", "hPa", "kPa", "bar", "mbar", "J",
    "Wh",  "W",   "V",     "mV",    "Ohm", "mOhm", "F",  "H",   "T",   "mT",  "uT",   "gauss"};

bool is_dimension_of(const Unit& unit, std::string_view of) {
  return unit.same_dimension(parse_unit(of));
}

/// The units that a quantity can be given in: "rad, deg or rev", "s, ms, us, min, h or Hz (its rate)".
std::string units_for(std::string_view needed) {
  const Unit wanted = parse_unit(needed);
  std::vector<std::string> units{std::string(needed)};
  if (std::find(std::begin(kUsual), std::end(kUsual), needed) != std::end(kUsual)) {
    for (const std::string_view usual : kUsual) {
      if (usual != needed && is_dimension_of(wanted, usual)) units.emplace_back(usual);
    }
  } else if (needed.starts_with("rad/")) {
    units.push_back("deg" + std::string(needed.substr(3)));
  }
  if (is_dimension_of(wanted, "s")) units.emplace_back("Hz (its rate)");
  if (is_dimension_of(wanted, "Hz")) units.emplace_back("s (its period)");
  std::string text = units.front();
  for (std::size_t i = 1; i < units.size(); ++i) text += (i + 1 < units.size() ? ", " : " or ") + units[i];
  return text;
}

std::string needs(std::string_view needed) {
  if (needed.empty()) return "needs a unit";
  return needed == "1" ? "needs a number without unit, or %" : "needs " + units_for(needed);
}

double convert(double value, const Unit& from, const Unit& to) {
  const double base = value * (from.numerator * to.denominator) / (from.denominator * to.numerator);
  return base + from.offset * (to.denominator / to.numerator);
}

}  // namespace

Unit parse_unit(std::string_view text) {
  text = trimmed(text);
  return text.empty() ? Unit{} : UnitParser(text).whole();
}

double parse_quantity(std::string_view text, std::string_view needed) {
  if (needed == "SI") needed = {};  // any unit will do
  text = trimmed(text);
  double value = 0.0;
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* begin = text.data() + (plus ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc()) {
    throw QuantityError(
        "found '" + std::string(text) + "', " +
        (needed.empty() || needed == "1" ? "needs a number" : "needs a number of " + units_for(needed)));
  }
  const std::string_view unit_text = trimmed({result.ptr, static_cast<std::size_t>(end - result.ptr)});
  if (unit_text.empty()) return value;

  Unit found;
  try {
    found = parse_unit(unit_text);
  } catch (const QuantityError& error) {
    throw QuantityError("found '" + std::string(unit_text) + "' (" + error.what() + "), " + needs(needed));
  }
  const Unit wanted = parse_unit(needed);
  if (needed.empty()) return convert(value, found, Unit{});
  if (found.same_dimension(wanted)) return convert(value, found, wanted);
  const Unit inverse = raised(wanted, -2);
  const bool time_or_rate = wanted.same_dimension(parse_unit("s")) || wanted.same_dimension(parse_unit("Hz"));
  if (time_or_rate && found.same_dimension(inverse)) {
    if (value == 0.0) throw QuantityError("found '" + std::string(text) + "', which has no reciprocal");
    // 1 / (value * found) in units of wanted.
    return (found.denominator * wanted.denominator) / (value * found.numerator * wanted.numerator);
  }
  throw QuantityError("found '" + std::string(unit_text) + "', " + needs(needed));
}

}  // namespace ironbird::scenarios
