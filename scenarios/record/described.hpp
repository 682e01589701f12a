#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

// What kinds of value `describe` may show. Every visitor of described structs (log encoder, schema writer,
// TOML reader) branches on these.

namespace ironbird::scenarios {

/// No bound: the default of the last two arguments of a visit.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A visitor that takes anything and does nothing.
struct AnyVisitor {
  template <class Value>
  void operator()(const char*, Value&, const char*, const char*, double = -kUnbounded,
                  double = kUnbounded) const {}
};

/// A struct with the static template `describe(self, visit)`.
template <class T>
concept Described = std::is_class_v<T> && requires(T& value) {
  std::remove_cv_t<T>::describe(value, AnyVisitor{});
};

/// An enumeration with `enumerators(E)`, an array of pairs (value, name).
template <class T>
concept NamedEnum = std::is_enum_v<T> && requires(T value) {
  enumerators(value);
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {
  static constexpr std::size_t kSize = N;
};

/// A text of bounded length: characters up to the first NUL.
template <class T>
struct IsCharArray : std::false_type {};
template <std::size_t N>
struct IsCharArray<std::array<char, N>> : std::true_type {};

template <class T>
struct IsVariant : std::false_type {};
template <class... T>
struct IsVariant<std::variant<T...>> : std::true_type {};

/// A dense Eigen matrix or vector of doubles with fixed size.
template <class T>
struct IsMatrix : std::false_type {};
template <int Rows, int Columns, int Options>
struct IsMatrix<Eigen::Matrix<double, Rows, Columns, Options, Rows, Columns>>
    : std::bool_constant<(Rows > 0 && Columns > 0)> {
  static constexpr int kRows = Rows;
  static constexpr int kColumns = Columns;
};

template <class T>
inline constexpr bool kIsQuaternion = std::is_same_v<T, Eigen::Quaternion<double>>;
template <class T>
inline constexpr bool kIsVector2 = std::is_same_v<T, Eigen::Matrix<double, 2, 1>>;
template <class T>
inline constexpr bool kIsVector3 = std::is_same_v<T, Eigen::Matrix<double, 3, 1>>;
template <class T>
inline constexpr bool kIsTime = std::is_same_v<T, std::chrono::nanoseconds>;

/// A described struct that holds nothing, such as an alternative that only says that it was chosen.
template <class T>
inline constexpr bool kIsEmptyStruct = std::is_class_v<T>&& std::is_empty_v<T>;

/// False, but only once a template is instantiated: for static_assert at the end of a chain of cases.
template <class>
inline constexpr bool kNoCase = false;

}  // namespace ironbird::scenarios
