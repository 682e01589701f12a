#pragma once

#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "simulator/types/linear_algebra.hpp"

namespace ironbird::simulator {

/// @throws std::invalid_argument "path = value unit, must be lower..upper" unless lower <= value <= upper; a
/// value that is not a number is refused too
void require_within(const std::string& path, double value, const char* unit, double lower, double upper);

/// Walks over a described struct and requires every number to be within its bounds.
class BoundsCheck {
 public:
  explicit BoundsCheck(std::string path) : path_(std::move(path)) {}

  template <class Value>
  void operator()(const char* name, const Value& value, const char* unit, const char* /*meaning*/,
                  double lower = -std::numeric_limits<double>::max(),
                  double upper = std::numeric_limits<double>::max()) const {
    check(path_ + "." + name, value, unit, lower, upper);
  }

 private:
  template <class Value>
  static void check(const std::string& path, const Value& value, const char* unit, double lower,
                    double upper) {
    if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, int>) {
      require_within(path, value, unit, lower, upper);
    } else if constexpr (std::is_same_v<Value, Vector3> || std::is_same_v<Value, Matrix3>) {
      for (const double component : value.reshaped()) require_within(path, component, unit, lower, upper);
    } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
      if (value) require_within(path, *value, unit, lower, upper);
    } else if constexpr (std::is_class_v<Value>) {
      Value::describe(value, BoundsCheck(path));
    }
  }

  std::string path_;
};

}  // namespace ironbird::simulator
