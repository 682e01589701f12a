#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/record/allowance.hpp"

namespace ironbird::scenarios {

/// What a field of a ROS message holds.
enum class Ros2Kind : std::uint8_t {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kString,
  kTime,
  kMessage
};

/// One field of a ROS message as its definition gives it.
struct Ros2Field {
  std::string name;
  Ros2Kind kind = Ros2Kind::kFloat64;
  std::size_t message = 0;       ///< index of its type, for kMessage
  std::size_t element_size = 0;  ///< least bytes of one element on the wire; 0: it holds nothing
  bool is_array = false;         ///< exactly `length` elements
  bool is_sequence = false;
  std::size_t length = 0;                                       ///< of an array
  std::size_t bound = std::numeric_limits<std::size_t>::max();  ///< of a sequence

  /// A sequence of at most one element: something that may be absent.
  bool is_optional() const { return is_sequence && bound == 1; }
};

/// The fields of one message type. What is not on the wire is left out: constants, structs without members,
/// arrays of none.
struct Ros2MessageType {
  std::string name;            ///< `geometry_msgs/Vector3`, or empty for the outermost
  std::size_t least_size = 0;  ///< bytes on the wire, without padding
  std::vector<Ros2Field> fields;
};

/// Reads a ros2msg schema text with all the types it brings along; the outermost type comes first.
/// Fields of our own types get back the capitals that ROS does not allow.
/// @param allowance  pays for the lines
/// @throws std::runtime_error with the line that is wrong or the type that is missing, contains itself or is
/// nested more than 64 deep
std::vector<Ros2MessageType> parse_ros2_schema(std::string_view name, std::string_view text,
                                               Allowance& allowance);

}  // namespace ironbird::scenarios
