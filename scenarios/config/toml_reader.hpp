#pragma once

#include <toml++/toml.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/config/config_error.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/record/described.hpp"

namespace ironbird::scenarios {

/// What a member's description allows.
struct Allowed {
  std::string_view unit;
  double lower = -kUnbounded;
  double upper = kUnbounded;
};

/// Fills described structs from TOML and collects what is wrong.
///
/// A missing key leaves its member as it is, so a struct's initialisers are the defaults. Numbers are in the
/// unit that `describe` gives, times in seconds; a string brings its own unit. Use read_toml() unless
/// findings of several tables are to be reported together.
class TomlReader {
 public:
  /// Fills `value` from `table`.
  /// @param path        of the table in the configuration, for messages; empty at the top
  /// @param also_known  keys of `table` that somebody else reads
  template <class T>
  void read(const toml::table& table, T& value, const std::string& path = "",
            std::initializer_list<std::string_view> also_known = {}) {
    Keys keys{{also_known.begin(), also_known.end()}, {}};
    T::describe(value, Member{*this, table, path, keys.known});
    if (has_unknown(table, keys.known)) {
      T::describe(value, InnerKeys{keys.inner});
      report_unknown(table, path, keys);
    }
  }

  /// Fills one value of any described kind.
  template <class T>
  void read_value(const toml::node& node, T& value, const Allowed& allowed, const std::string& path);

  const std::vector<std::string>& findings() const { return findings_; }

  /// @throws ConfigError when anything was wrong
  void finish() const;

 private:
  /// What a table may hold.
  struct Keys {
    std::vector<std::string> known;
    std::vector<std::string> inner;  ///< of its members' members, as `geodetic.latitude`
  };

  struct Member {
    TomlReader& reader;
    const toml::table& table;
    const std::string& path;
    std::vector<std::string>& known;

    template <class T>
    void operator()(const char* name, T& value, const char* unit, const char*, double lower = -kUnbounded,
                    double upper = kUnbounded) const {
      known.emplace_back(name);
      const toml::node* node = table.get(name);
      if (node == nullptr) return;
      reader.read_value(*node, value, {unit, lower, upper}, path.empty() ? name : path + "." + name);
    }
  };

  /// Collects the names of the members of described members.
  struct InnerKeys {
    std::vector<std::string>& keys;

    template <class T, class... Rest>
    void operator()(const char* name, T&, const Rest&...) const {
      if constexpr (IsOptional<T>::value) {
        add<typename T::value_type>(name);
      } else {
        add<T>(name);
      }
    }

   private:
    template <class T>
    void add(const char* name) const {
      if constexpr (Described<T>) {
        const T any{};
        T::describe(
            any, [&](const char* inner, const auto&...) { keys.push_back(std::string(name) + "." + inner); });
      }
    }
  };

  template <class T>
  void read_integer(const toml::node& node, T& value, const Allowed& allowed, const std::string& path);
  template <class T>
  void read_enum(const toml::node& node, T& value, const std::string& path);
  template <class T>
  void read_matrix(const toml::node& node, T& value, const Allowed& allowed, const std::string& path);
  template <class T>
  void read_array(const toml::node& node, T& value, const Allowed& allowed, const std::string& path);
  template <class T>
  void read_vector(const toml::node& node, T& value, const Allowed& allowed, const std::string& path);

  void read_bool(const toml::node& node, bool& value, const std::string& path);
  void read_text(const toml::node& node, std::string& value, const std::string& path);
  void read_number(const toml::node& node, double& value, const Allowed& allowed, const std::string& path);
  void read_time(const toml::node& node, std::chrono::nanoseconds& value, const Allowed& allowed,
                 const std::string& path);
  void read_quaternion(const toml::node& node, Eigen::Quaternion<double>& value, const std::string& path);
  std::optional<std::int64_t> integer(const toml::node& node, const Allowed& allowed, const std::string& path,
                                      double least, double greatest);
  /// The elements when there are between `least` and `most` of them; else null, and a finding.
  const toml::array* elements(const toml::node& node, std::size_t least, std::size_t most,
                              const std::string& path);
  std::optional<std::string> name(const toml::node& node, const std::string& path,
                                  const std::vector<std::string>& names);
  static bool has_unknown(const toml::table& table, const std::vector<std::string>& known);
  /// The known key that was probably meant, or nothing.
  static std::string meant(std::string_view key, const Keys& keys);
  void report_unknown(const toml::table& table, const std::string& path, const Keys& keys);
  void report(const toml::node& node, const std::string& path, const std::string& what);
  /// Says which form is right where a table, or an array of tables, was not found.
  void report_no_table(const toml::node& node, const std::string& path);
  void report_no_tables(const toml::node& node, const std::string& path);

  std::vector<std::string> findings_;
};

/// Fills `value` from `table`. @throws ConfigError with every finding
template <class T>
void read_toml(const toml::table& table, T& value, const std::string& path = "",
               std::initializer_list<std::string_view> also_known = {}) {
  TomlReader reader;
  reader.read(table, value, path, also_known);
  reader.finish();
}

/// Sets one member of a described struct, as `--set path=text` asks. @throws ConfigError
template <class T>
void apply(T& value, std::string_view path, std::string_view text) {
  toml::table table;
  set_value(table, path, text);
  read_toml(table, value);
}

template <class T>
void TomlReader::read_value(const toml::node& node, T& value, const Allowed& allowed,
                            const std::string& path) {
  if constexpr (std::is_same_v<T, bool>) {
    read_bool(node, value, path);
  } else if constexpr (std::is_integral_v<T>) {
    read_integer(node, value, allowed, path);
  } else if constexpr (std::is_floating_point_v<T>) {
    double number = value;
    read_number(node, number, allowed, path);
    value = static_cast<T>(number);
  } else if constexpr (NamedEnum<T>) {
    read_enum(node, value, path);
  } else if constexpr (kIsTime<T>) {
    read_time(node, value, allowed, path);
  } else if constexpr (std::is_same_v<T, std::string>) {
    read_text(node, value, path);
  } else if constexpr (kIsQuaternion<T>) {
    read_quaternion(node, value, path);
  } else if constexpr (IsMatrix<T>::value) {
    read_matrix(node, value, allowed, path);
  } else if constexpr (IsArray<T>::value) {
    read_array(node, value, allowed, path);
  } else if constexpr (IsVector<T>::value) {
    read_vector(node, value, allowed, path);
  } else if constexpr (IsOptional<T>::value) {
    if (!value) value.emplace();
    read_value(node, *value, allowed, path);
  } else {
    static_assert(Described<T>, "a member of this type cannot come from a configuration");
    if (const toml::table* table = node.as_table()) return read(*table, value, path);
    report_no_table(node, path);
  }
}

template <class T>
void TomlReader::read_integer(const toml::node& node, T& value, const Allowed& allowed,
                              const std::string& path) {
  const auto number = integer(node, allowed, path, static_cast<double>(std::numeric_limits<T>::lowest()),
                              static_cast<double>(std::numeric_limits<T>::max()));
  if (number) value = static_cast<T>(*number);
}

template <class T>
void TomlReader::read_enum(const toml::node& node, T& value, const std::string& path) {
  std::vector<std::string> names;
  for (const auto& [enumerator, text] : enumerators(T{})) names.emplace_back(text);
  const auto found = name(node, path, names);
  if (!found) return;
  for (const auto& [enumerator, text] : enumerators(T{})) {
    if (text == *found) value = enumerator;
  }
}

template <class T>
void TomlReader::read_matrix(const toml::node& node, T& value, const Allowed& allowed,
                             const std::string& path) {
  constexpr std::size_t kRows = IsMatrix<T>::kRows;
  constexpr std::size_t kColumns = IsMatrix<T>::kColumns;
  const toml::array* rows = elements(node, kRows, kRows, path);
  if (rows == nullptr) return;
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string row_path = path + "[" + std::to_string(row) + "]";
    const auto i = static_cast<Eigen::Index>(row);
    if constexpr (kColumns == 1) {
      read_number(*rows->get(row), value(i, 0), allowed, row_path);
    } else {
      const toml::array* columns = elements(*rows->get(row), kColumns, kColumns, row_path);
      for (std::size_t column = 0; columns != nullptr && column < kColumns; ++column) {
        read_number(*columns->get(column), value(i, static_cast<Eigen::Index>(column)), allowed,
                    row_path + "[" + std::to_string(column) + "]");
      }
    }
  }
}

template <class T>
void TomlReader::read_array(const toml::node& node, T& value, const Allowed& allowed,
                            const std::string& path) {
  const toml::array* array = elements(node, 0, value.size(), path);
  if (array == nullptr) return;
  for (std::size_t i = 0; i < array->size(); ++i) {
    read_value(*array->get(i), value[i], allowed, path + "[" + std::to_string(i) + "]");
  }
}

template <class T>
void TomlReader::read_vector(const toml::node& node, T& value, const Allowed& allowed,
                             const std::string& path) {
  if constexpr (Described<typename T::value_type>) {
    if (!node.is_array()) return report_no_tables(node, path);
  }
  const toml::array* array = elements(node, 0, std::numeric_limits<std::size_t>::max(), path);
  if (array == nullptr) return;
  T result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    typename T::value_type element{};
    read_value(*array->get(i), element, allowed, path + "[" + std::to_string(i) + "]");
    result.push_back(std::move(element));
  }
  value = std::move(result);
}

}  // namespace ironbird::scenarios
