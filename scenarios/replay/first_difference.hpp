#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/record/ros2_message.hpp"

namespace ironbird::scenarios {

/// The first field in which two messages of one type are not the same to the last bit.
struct FieldDifference {
  std::string field;
  std::string was;
  std::string is;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("field", self.field, "", "its path in the message; empty: none can be named");
    visit("was", self.was, "", "in the one, with all its digits");
    visit("is", self.is, "", "in the other");
  }
};

/// Where two messages differ, numbers in the order of the fields first, then texts. A part that one of them
/// lacks is `no number`.
/// @param types  of both, as parse_ros2_schema() gives them
FieldDifference difference_of(const std::vector<Ros2MessageType>& types, std::span<const std::uint8_t> was,
                              std::span<const std::uint8_t> is);

}  // namespace ironbird::scenarios
