#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/config/digest.hpp"
#include "scenarios/record/described.hpp"

namespace ironbird::scenarios {

/// Writes described structs as TOML that read_toml() reads back to the same values, to the bit.
///
/// Members come in the order of `describe`, single values before tables as TOML demands. An absent optional
/// is left out; times are in seconds.
class EffectiveWriter {
 public:
  explicit EffectiveWriter(bool with_comments) : with_comments_(with_comments) {}

  /// Appends the members of `value` and, behind them, its tables.
  template <class T>
  void write(const T& value, const std::string& path) {
    T::describe(value, Values{*this});
    T::describe(value, Tables{*this, path});
  }

  const std::string& text() const { return text_; }

 private:
  struct Values {
    EffectiveWriter& writer;
    template <class T>
    void operator()(const char* name, const T& value, const char* unit, const char* meaning, double = 0.0,
                    double = 0.0) const {
      writer.write_member(name, value, unit, meaning);
    }
  };
  struct Tables {
    EffectiveWriter& writer;
    const std::string& path;
    template <class T>
    void operator()(const char* name, const T& value, const char*, const char* meaning, double = 0.0,
                    double = 0.0) const {
      writer.write_table(path.empty() ? name : path + "." + name, value, meaning);
    }
  };

  /// True for what stands under a header of its own.
  template <class T>
  static constexpr bool is_table() {
    if constexpr (IsOptional<T>::value) {
      return is_table<typename T::value_type>();
    } else if constexpr (IsVector<T>::value || (IsArray<T>::value && !IsCharArray<T>::value)) {
      return is_table<typename T::value_type>();
    } else {
      return Described<T>;
    }
  }

  template <class T>
  void write_member(const char* name, const T& value, std::string_view unit, std::string_view meaning) {
    if constexpr (IsOptional<T>::value) {
      if (value) write_member(name, *value, unit, meaning);
    } else if constexpr (!is_table<T>()) {
      add_line(name, literal(value), kIsTime<T> ? "s" : unit, meaning);
    } else if constexpr (IsVector<T>::value) {
      if (value.empty()) add_line(name, "[]", "", meaning);
    }
  }

  template <class T>
  void write_table(const std::string& path, const T& value, std::string_view meaning) {
    if constexpr (IsOptional<T>::value) {
      if (value) write_table(path, *value, meaning);
    } else if constexpr (is_table<T>()) {
      if constexpr (IsVector<T>::value || IsArray<T>::value) {
        for (const auto& element : value) {
          add_header("[[" + path + "]]", meaning);
          write(element, path);
        }
      } else {
        add_header("[" + path + "]", meaning);
        write(value, path);
      }
    }
  }

  template <class T>
  static std::string literal(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      return value ? "true" : "false";
    } else if constexpr (std::is_integral_v<T>) {
      return std::to_string(value);
    } else if constexpr (std::is_floating_point_v<T>) {
      return number(value);
    } else if constexpr (NamedEnum<T>) {
      for (const auto& [enumerator, name] : enumerators(T{})) {
        if (enumerator == value) return quoted(name);
      }
      return quoted("");
    } else if constexpr (kIsTime<T>) {
      return number(static_cast<double>(value.count()) / 1e9);
    } else if constexpr (std::is_same_v<T, std::string>) {
      return quoted(value);
    } else if constexpr (kIsQuaternion<T>) {
      return list(std::vector<double>{value.w(), value.x(), value.y(), value.z()});
    } else if constexpr (IsMatrix<T>::value) {
      return matrix(value);
    } else {
      static_assert(IsArray<T>::value || IsVector<T>::value, "a member of this type has no TOML form");
      return list(value);
    }
  }

  template <class Elements>
  static std::string list(const Elements& elements) {
    std::string text = "[";
    for (const auto& element : elements) text += (text.size() > 1 ? ", " : "") + literal(element);
    return text + "]";
  }

  template <class Matrix>
  static std::string matrix(const Matrix& value) {
    std::vector<std::string> rows;
    std::string text = "[";
    for (Eigen::Index row = 0; row < value.rows(); ++row) {
      std::vector<double> numbers;
      for (Eigen::Index column = 0; column < value.cols(); ++column) numbers.push_back(value(row, column));
      text += (row > 0 ? ", " : "") + (value.cols() == 1 ? literal(numbers[0]) : list(numbers));
    }
    return text + "]";
  }

  static std::string number(double value);
  static std::string quoted(std::string_view text);
  void add_line(std::string_view name, const std::string& value, std::string_view unit,
                std::string_view meaning);
  void add_header(const std::string& header, std::string_view meaning);

  bool with_comments_;
  std::string text_;
};

/// The configuration in force as TOML, each line with its unit and meaning.
template <class T>
std::string effective(const T& value) {
  EffectiveWriter writer(true);
  writer.write(value, "");
  return writer.text();
}

/// SHA-256 of the configuration in force: of its TOML without comments, so that a better worded meaning does
/// not change it.
template <class T>
std::string config_digest(const T& value) {
  EffectiveWriter writer(false);
  writer.write(value, "");
  return digest(writer.text());
}

}  // namespace ironbird::scenarios
