#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/record/described.hpp"
#include "scenarios/record/type_name.hpp"

namespace ironbird::scenarios {

/// A message type in ROS 2's own notation, with every type that it uses.
struct Ros2Schema {
  std::string name;  ///< `ironbird_msgs/msg/StateEstimate`
  std::string text;  ///< the definition, then each used type behind a line of `=` and a line `MSG: name`

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "package, msg and type");
    visit("text", self.text, "", "definition in ros2msg notation");
  }
};

/// Collects the definitions that one schema consists of. Used through ros2_schema().
class Ros2SchemaBuilder {
 public:
  /// The message name of T, which is defined now if it was not before.
  /// @param suggestion  name for a type that has none of its own, such as a variant
  template <class T>
  std::string define(std::string_view suggestion);

  Ros2Schema finish() const;

 private:
  struct Definition {
    std::string name;  ///< `ironbird_msgs/StateEstimate`
    std::string type;  ///< the C++ type, to find two types of one name
    std::string body;
    std::vector<std::string> fields;
  };

  struct Member {
    Ros2SchemaBuilder& builder;
    std::size_t definition;
    template <class T>
    void operator()(const char* name, const T&, const char* unit, const char* meaning,
                    double lower = -kUnbounded, double upper = kUnbounded) const {
      builder.add_field<T>(definition, name, comment(unit, meaning, lower, upper));
    }
  };

  template <class T>
  void add_field(std::size_t definition, std::string_view name, const std::string& comment);
  template <class T>
  std::string element_type(std::string_view field);
  template <class T>
  void add_enumerators(std::size_t definition, std::string_view field);
  template <class Variant, std::size_t... Index>
  void add_alternatives(std::size_t definition, std::index_sequence<Index...>);
  template <class T>
  void add_alternative(std::size_t definition);

  std::string define_standard(std::string_view name, std::string_view body);
  /// Index of a new, empty definition, or kKnown when this very type has one. @throws std::invalid_argument
  /// when another type has this name
  std::size_t open(std::string_view name, std::string_view type);
  void add_line(std::size_t definition, std::string_view type, std::string_view name,
                const std::string& comment);
  void add_constant(std::size_t definition, std::string_view prefix, std::string_view name, unsigned value);
  static std::string comment(std::string_view unit, std::string_view meaning, double lower, double upper);

  static constexpr std::size_t kKnown = static_cast<std::size_t>(-1);
  std::vector<Definition> definitions_;
};

/// The message type that CdrEncoder writes T as.
///
/// ROS allows only small letters in names of fields, and its tools refuse others: `p_NB_N` becomes `p_nb_n`,
/// and the comment begins with `p_NB_N:`, from which our own reader takes the name back.
/// @param suggestion  name for a type that has none of its own, such as a variant: `setpoint` makes
/// `Setpoint`
template <class T>
Ros2Schema ros2_schema(std::string_view suggestion = "Value") {
  Ros2SchemaBuilder builder;
  builder.define<T>(suggestion);
  return builder.finish();
}

/// ROS name of a number type.
template <class T>
constexpr std::string_view ros2_number() {
  if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else if constexpr (std::is_same_v<T, double>) {
    return "float64";
  } else if constexpr (std::is_same_v<T, float>) {
    return "float32";
  } else {
    static_assert(std::is_integral_v<T> && sizeof(T) <= 8, "no ROS type for this number");
    constexpr std::array<std::string_view, 4> kSigned{"int8", "int16", "int32", "int64"};
    constexpr std::array<std::string_view, 4> kUnsigned{"uint8", "uint16", "uint32", "uint64"};
    constexpr std::size_t index = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return std::is_signed_v<T> ? kSigned[index] : kUnsigned[index];
  }
}

template <class T>
std::string Ros2SchemaBuilder::define(std::string_view suggestion) {
  const std::string name =
      "ironbird_msgs/" + (IsVariant<T>::value ? camel_case(suggestion) : std::string(short_type_name<T>()));
  const std::size_t definition = open(name, full_type_name<T>());
  if (definition == kKnown) return name;
  if constexpr (IsVariant<T>::value) {
    add_alternatives<T>(definition, std::make_index_sequence<std::variant_size_v<T>>{});
  } else if constexpr (kIsEmptyStruct<T>) {
    add_line(definition, "uint8", "structure_needs_at_least_one_member", "");
  } else {
    static_assert(Described<T>, "a message is a described struct or a variant of such");
    const T sample{};
    T::describe(sample, Member{*this, definition});
  }
  return name;
}

template <class T>
std::string Ros2SchemaBuilder::element_type(std::string_view field) {
  if constexpr (std::is_arithmetic_v<T>) {
    return std::string(ros2_number<T>());
  } else if constexpr (NamedEnum<T>) {
    return "uint8";
  } else if constexpr (kIsTime<T>) {
    return define_standard("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
  } else if constexpr (kIsVector3<T>) {
    return define_standard("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
  } else if constexpr (kIsVector2<T>) {
    return define_standard("ironbird_msgs/Vector2", "float64 x\nfloat64 y\n");
  } else if constexpr (kIsQuaternion<T>) {
    return define_standard("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
  } else if constexpr (std::is_same_v<T, std::string> || IsCharArray<T>::value) {
    return "string";
  } else {
    static_assert(!IsMatrix<T>::value && !IsArray<T>::value && !IsVector<T>::value && !IsOptional<T>::value,
                  "a ROS sequence cannot hold sequences: put the inner one into a struct");
    return define<T>(field);
  }
}

template <class T>
void Ros2SchemaBuilder::add_field(std::size_t definition, std::string_view name, const std::string& comment) {
  if constexpr (IsMatrix<T>::value && !kIsVector2<T> && !kIsVector3<T>) {
    const std::string size = std::to_string(IsMatrix<T>::kRows * IsMatrix<T>::kColumns);
    add_line(definition, "float64[" + size + "]", name, comment);
  } else if constexpr (IsArray<T>::value && !IsCharArray<T>::value) {
    using Element = typename T::value_type;
    add_enumerators<Element>(definition, name);
    const std::string size = "[" + std::to_string(IsArray<T>::kSize) + "]";
    add_line(definition, element_type<Element>(name) + size, name, comment);
  } else if constexpr (IsVector<T>::value || IsOptional<T>::value) {
    using Element = typename T::value_type;
    add_enumerators<Element>(definition, name);
    const std::string size = IsOptional<T>::value ? "[<=1]" : "[]";
    add_line(definition, element_type<Element>(name) + size, name, comment);
  } else {
    add_enumerators<T>(definition, name);
    add_line(definition, element_type<T>(name), name, comment);
  }
}

template <class T>
void Ros2SchemaBuilder::add_enumerators(std::size_t definition, std::string_view field) {
  if constexpr (NamedEnum<T>) {
    for (const auto& [value, name] : enumerators(T{})) {
      add_constant(definition, field, name, static_cast<unsigned>(value));
    }
  }
}

template <class Variant, std::size_t... Index>
void Ros2SchemaBuilder::add_alternatives(std::size_t definition, std::index_sequence<Index...>) {
  (add_constant(definition, "kind", snake_case(short_type_name<std::variant_alternative_t<Index, Variant>>()),
                Index),
   ...);
  add_line(definition, "uint8", "kind", "which of the alternatives it is");
  (add_alternative<std::variant_alternative_t<Index, Variant>>(definition), ...);
}

template <class T>
void Ros2SchemaBuilder::add_alternative(std::size_t definition) {
  if constexpr (!kIsEmptyStruct<T>) {
    add_field<std::optional<T>>(definition, snake_case(short_type_name<T>()), "");
  }
}

}  // namespace ironbird::scenarios
