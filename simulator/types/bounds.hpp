#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace ironbird::simulator {

/// Visitor that holds every number of a described struct against its own bounds.
class BoundsCheck {
 public:
  explicit BoundsCheck(std::string path) : path_(std::move(path)) {}

  template <class Value>
  void operator()(const char* name, const Value& value, const char* unit, const char*,
                  double lower = -std::numeric_limits<double>::infinity(),
                  double upper = std::numeric_limits<double>::infinity()) const {
    examine(path_ + "." + name, value, unit, lower, upper);
  }

 private:
  template <class Value>
  static void examine(const std::string& path, const Value& value, const char* unit, double lower,
                      double upper) {
    if constexpr (requires { Value::describe(value, BoundsCheck(path)); }) {
      Value::describe(value, BoundsCheck(path));
    } else if constexpr (std::is_arithmetic_v<Value>) {
      examine_number(path, static_cast<double>(value), unit, lower, upper);
    } else if constexpr (requires { value.has_value(); }) {
      if (value) examine(path, *value, unit, lower, upper);
    } else if constexpr (requires { value.reshaped(); }) {
      for (int i = 0; i < value.size(); ++i) {
        examine(path + "[" + std::to_string(i) + "]", value.reshaped()[i], unit, lower, upper);
      }
    } else if constexpr (requires { value.begin(), value.end(); } && !std::is_same_v<Value, std::string>) {
      int index = 0;
      for (const auto& item : value) {
        examine(path + "[" + std::to_string(index++) + "]", item, unit, lower, upper);
      }
    }
  }

  static void examine_number(const std::string& path, double value, const char* unit, double lower,
                             double upper) {
    if (std::isfinite(value) && value >= lower && value <= upper) return;
    std::ostringstream text;
    text << path << " = " << value;
    if (std::string_view(unit) != "1") text << ' ' << unit;
    text << ", must be ";
    if (std::isfinite(lower) || std::isfinite(upper)) {
      text << "between " << lower << " and " << upper;
    } else {
      text << "finite";
    }
    throw std::invalid_argument(text.str());
  }

  std::string path_;
};

/// @throws std::invalid_argument naming the first number in `params` that is not finite or outside its bounds
template <class Params>
void check_bounds(const Params& params, const std::string& path) {
  Params::describe(params, BoundsCheck(path));
}

}  // namespace ironbird::simulator
