#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "scenarios/record/type_name.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

/// One number inside a live struct: where it lies and how it is read.
struct SignalLeaf {
  /// Says whether the optional part or the alternative that the number lies in is there.
  struct Guard {
    bool (*present)(const void*);
    const void* object;
  };

  std::string path;
  std::string unit;
  std::string meaning;
  const void* address = nullptr;
  double (*read)(const void*) = nullptr;
  std::vector<Guard> guards;
  std::vector<std::string> names;  ///< of the values 0, 1, 2, … when the leaf is an enumeration or a truth
  std::vector<double> numbers;     ///< the number that each name stands for
  Angles angles = Angles::kDegrees;  ///< what people count it in, when it is about an angle

  bool present() const {
    for (const Guard& guard : guards) {
      if (!guard.present(guard.object)) return false;
    }
    return true;
  }

  /// NaN when absent.
  double value() const;
};

/// A number or a vector of a live struct, bound once and read every tick without allocation.
class Signal {
 public:
  Signal() = default;

  const std::string& path() const { return path_; }
  const std::string& unit() const { return leaf_[0]->unit; }

  Angles angles() const { return leaf_[0]->angles; }

  /// 1, or 2 or 3 for a vector addressed as a whole.
  int size() const { return size_; }

  /// True for roll, pitch and heading: differences go the short way round.
  bool is_angle() const;

  /// True when the struct holds the signal now. Absent: inside an empty optional or another alternative.
  bool present() const { return leaf_[0]->present(); }

  /// Component `i`, SI; NaN when absent.
  double value(int i = 0) const { return leaf_[static_cast<std::size_t>(i)]->value(); }

  /// All components; those beyond size() are 0.
  Eigen::Vector3d vector() const;

  const SignalLeaf& leaf(int i = 0) const { return *leaf_[static_cast<std::size_t>(i)]; }

 private:
  friend class SignalTable;
  std::string path_;
  std::array<const SignalLeaf*, 3> leaf_{};
  int size_ = 0;
};

/// Every number of the live structs of a run under its path: `truth.p_NB_N.x`, `autopilot.estimate.health`,
/// `truth.rotor_speed[2]`, `autopilot.command.rate_command.throttle`, `autopilot.route.waypoints.size`.
///
/// A vector can be addressed as a whole (`truth.p_NB_N`). Beside each attitude `q_NB` stand its ZYX angles
/// `roll`, `pitch` and `heading`. Times are seconds; a variant reads as the number of its alternative.
/// Texts and the elements of sequences are not listed.
class SignalTable {
 public:
  SignalTable() = default;
  SignalTable(const SignalTable&) = delete;
  SignalTable& operator=(const SignalTable&) = delete;

  /// Lists every number of `object`, whose address must stay valid as long as the table's signals are read.
  template <class Struct>
  void add(const std::string& prefix, const Struct& object);

  /// Elements of the array `path` from `count` on are no signals: they lie in the struct and mean nothing.
  /// @param reason  for the message when one of them is asked for
  void shorten(const std::string& path, std::size_t count, const std::string& reason);

  /// @throws std::invalid_argument naming the nearest paths when there is no such signal
  Signal find(std::string_view path) const;

  /// All leaves, in order of registration.
  const std::deque<SignalLeaf>& leaves() const { return leaves_; }

 private:
  struct Walk;

  void add_leaf(SignalLeaf leaf);
  void add_attitude_angles();
  const SignalLeaf* leaf(std::string_view path) const;

  std::deque<SignalLeaf> leaves_;
  std::map<std::string, const SignalLeaf*, std::less<>> by_path_;
  std::map<std::string, std::string, std::less<>> void_;  ///< paths that shorten() took, each with its reason
  std::vector<SignalLeaf> attitudes_;
};

/// Visits one struct. Parts that may be absent are visited on a `sample` of the same layout; what is found
/// there is registered at the same place of the `live` object.
struct SignalTable::Walk {
  SignalTable& table;
  std::string path;
  const std::byte* sample;
  const std::byte* live;
  std::vector<SignalLeaf::Guard> guards;

  template <class Value, class... Bounds>
  void operator()(const char* name, const Value& member, const char* unit, const char* meaning,
                  Bounds...) const {
    add(path + "." + name, member, unit, meaning);
  }

 private:
  template <class Value>
  const std::byte* live_address(const Value& member) const {
    return live + (reinterpret_cast<const std::byte*>(&member) - sample);
  }

  /// Rotors alone are spoken of in rad/s.
  static Angles angles_of(const std::string& leaf_path) {
    return leaf_path.find(".rotor_speed") == std::string::npos ? Angles::kDegrees : Angles::kRadians;
  }

  template <class Value>
  static double read_number(const void* address) {
    return static_cast<double>(*static_cast<const Value*>(address));
  }
  template <class Duration>
  static double read_seconds(const void* address) {
    return std::chrono::duration<double>(*static_cast<const Duration*>(address)).count();
  }
  template <class Vector>
  static double read_size(const void* address) {
    return static_cast<double>(static_cast<const Vector*>(address)->size());
  }
  template <class Variant>
  static double read_index(const void* address) {
    return static_cast<double>(static_cast<const Variant*>(address)->index());
  }

  void leaf(const std::string& leaf_path, const void* address, double (*read)(const void*),
            const std::string& unit, const std::string& meaning, std::vector<std::string> names = {},
            std::vector<double> numbers = {}) const {
    table.add_leaf({leaf_path, unit, meaning, address, read, guards, std::move(names), std::move(numbers),
                    angles_of(leaf_path)});
  }

  template <class Value>
  void add(const std::string& at, const Value& member, const char* unit, const char* meaning) const {
    if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, char>) {
      return;
    } else if constexpr (std::is_same_v<Value, bool>) {
      leaf(at, live_address(member), &read_number<bool>, unit, meaning, {"false", "true"}, {0.0, 1.0});
    } else if constexpr (std::is_arithmetic_v<Value>) {
      leaf(at, live_address(member), &read_number<Value>, unit, meaning);
    } else if constexpr (std::is_enum_v<Value>) {
      add_enumeration(at, member, unit, meaning);
    } else {
      add_compound(at, member, unit, meaning);
    }
  }

  template <class Enum>
  void add_enumeration(const std::string& at, const Enum& member, const char* unit,
                       const char* meaning) const {
    std::vector<std::string> names;
    std::vector<double> numbers;
    for (const auto& [value, name] : enumerators(Enum{})) {
      names.emplace_back(name);
      numbers.push_back(static_cast<double>(value));
    }
    leaf(at, live_address(member), &read_number<Enum>, unit, meaning, names, numbers);
  }

  template <class Rep, class Period>
  void add_compound(const std::string& at, const std::chrono::duration<Rep, Period>& member, const char*,
                    const char* meaning) const {
    leaf(at, live_address(member), &read_seconds<std::chrono::duration<Rep, Period>>, "s", meaning);
  }

  template <int Rows, int Columns, int Options>
  void add_compound(const std::string& at, const Eigen::Matrix<double, Rows, Columns, Options>& member,
                    const char* unit, const char* meaning) const {
    static_assert(Rows > 0 && Columns > 0, "a described matrix has a fixed size");
    for (int row = 0; row < Rows; ++row) {
      for (int column = 0; column < Columns; ++column) {
        const bool is_vector = Columns == 1 && Rows <= 3;
        const std::string name =
            is_vector ? std::string(".") + "xyz"[row] : "[" + std::to_string(row * Columns + column) + "]";
        leaf(at + name, live_address(member.coeffRef(row, column)), &read_number<double>, unit, meaning);
      }
    }
  }

  void add_compound(const std::string& at, const Eigen::Quaterniond& member, const char* unit,
                    const char* meaning) const {
    leaf(at + ".w", live_address(member.coeffs().coeffRef(3)), &read_number<double>, unit, meaning);
    for (int i = 0; i < 3; ++i) {
      leaf(at + "." + "xyz"[i], live_address(member.coeffs().coeffRef(i)), &read_number<double>, unit,
           meaning);
    }
    table.attitudes_.push_back({at, unit, meaning, live_address(member), nullptr, guards, {}, {}});
  }

  template <class Value>
  void add_compound(const std::string& at, const std::optional<Value>& member, const char* unit,
                    const char* meaning) const {
    const std::optional<Value> filled(std::in_place);
    Walk inner{table, at, reinterpret_cast<const std::byte*>(&filled), live_address(member), guards};
    inner.guards.push_back(
        {[](const void* object) { return static_cast<const std::optional<Value>*>(object)->has_value(); },
         live_address(member)});
    inner.add(at, *filled, unit, meaning);
  }

  template <class... Alternatives>
  void add_compound(const std::string& at, const std::variant<Alternatives...>& member, const char*,
                    const char* meaning) const {
    std::vector<std::string> names{snake_case(short_type_name<Alternatives>())...};
    std::vector<double> numbers;
    for (std::size_t i = 0; i < names.size(); ++i) numbers.push_back(static_cast<double>(i));
    leaf(at, live_address(member), &read_index<std::variant<Alternatives...>>, "1", meaning, names, numbers);
    add_alternatives(at, member, names, meaning, std::index_sequence_for<Alternatives...>{});
  }

  template <class Variant, std::size_t... Index>
  void add_alternatives(const std::string& at, const Variant& member, const std::vector<std::string>& names,
                        const char* meaning, std::index_sequence<Index...>) const {
    (add_alternative<Index>(at + "." + names[Index], member, meaning), ...);
  }

  template <std::size_t Index, class Variant>
  void add_alternative(const std::string& at, const Variant& member, const char* meaning) const {
    const Variant filled(std::in_place_index<Index>);
    Walk inner{table, at, reinterpret_cast<const std::byte*>(&filled), live_address(member), guards};
    inner.guards.push_back(
        {[](const void* object) { return static_cast<const Variant*>(object)->index() == Index; },
         live_address(member)});
    inner.add(at, std::get<Index>(filled), "", meaning);
  }

  template <class Value, std::size_t Size>
  void add_compound(const std::string& at, const std::array<Value, Size>& member, const char* unit,
                    const char* meaning) const {
    for (std::size_t i = 0; i < Size; ++i) {
      add(at + "[" + std::to_string(i) + "]", member[i], unit, meaning);
    }
  }

  template <class Value>
  void add_compound(const std::string& at, const std::vector<Value>& member, const char*,
                    const char* meaning) const {
    leaf(at + ".size", live_address(member), &read_size<std::vector<Value>>, "1", meaning);
  }

  template <class Struct>
  void add_compound(const std::string& at, const Struct& member, const char*, const char*) const {
    Struct::describe(member, Walk{table, at, sample, live, guards});
  }
};

template <class Struct>
void SignalTable::add(const std::string& prefix, const Struct& object) {
  const auto* start = reinterpret_cast<const std::byte*>(&object);
  Struct::describe(object, Walk{*this, prefix, start, start, {}});
  add_attitude_angles();
}

}  // namespace ironbird::scenarios
