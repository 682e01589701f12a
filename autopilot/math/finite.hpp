#pragma once

#include <optional>
#include <type_traits>
#include <variant>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// Visits a described struct and remembers whether every floating-point number in it is finite. Integers,
/// flags, stamps and enumerations always are.
class FiniteVisitor {
 public:
  bool finite() const { return differences_ == 0.0; }

  template <class Value, class... Rest>
  void operator()(const char*, const Value& value, Rest&&...) {
    look(value);
  }

 private:
  // x - x is 0 for every finite x and NaN for every other: one sum, no branches.
  void look(double value) { differences_ += value - value; }
  void look(const Quaternion& value) { look_at(value.coeffs()); }

  template <int rows, int columns>
  void look(const Eigen::Matrix<double, rows, columns>& value) {
    look_at(value);
  }
  template <class Coefficients>
  void look_at(const Coefficients& value) {
    for (Eigen::Index i = 0; i < value.size(); ++i) look(value(i));
  }

  template <class Value>
  void look(const std::optional<Value>& value) {
    if (value) look(*value);
  }

  template <class Value>
  void look(const Value& value) {
    if constexpr (requires { Value::describe(value, *this); }) Value::describe(value, *this);
  }

  double differences_ = 0.0;
};

/// True when every floating-point number in the described struct is finite.
template <class Described>
bool all_finite(const Described& value) {
  FiniteVisitor visitor;
  Described::describe(value, visitor);
  return visitor.finite();
}

/// True when every floating-point number in the alternative that is held is finite.
template <class... Described>
bool all_finite(const std::variant<Described...>& value) {
  return std::visit([](const auto& held) { return all_finite(held); }, value);
}

}  // namespace ironbird::autopilot
