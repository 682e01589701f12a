#pragma once

#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

/// Visits a described struct and remembers whether every floating-point number in it is finite. Integers,
/// flags, stamps and enumerations always are.
class FiniteVisitor {
 public:
  bool finite() const { return finite_; }

  template <class Value, class... Rest>
  void operator()(const char*, const Value& value, Rest&&...) {
    look(value);
  }

 private:
  void look(double value) { finite_ = finite_ && std::isfinite(value); }
  void look(const Quaternion& value) { finite_ = finite_ && value.coeffs().allFinite(); }

  template <int rows, int columns>
  void look(const Eigen::Matrix<double, rows, columns>& value) {
    finite_ = finite_ && value.allFinite();
  }

  template <class Value>
  void look(const std::optional<Value>& value) {
    if (value) look(*value);
  }

  template <class Value>
  void look(const Value& value) {
    if constexpr (requires { Value::describe(value, *this); }) Value::describe(value, *this);
  }

  bool finite_ = true;
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
