#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {

/// A scenario that can be flown.
inline constexpr const char* kMission = "title = \"t\"\nduration = \"8 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n";

/// A scenario or an option that is wrong, and what must be said about it.
struct BadInput {
  const char* name;
  std::string scenario;
  std::string options;
  std::vector<std::string> says;  // all of these
};

inline std::ostream& operator<<(std::ostream& stream, const BadInput& input) {
  return stream << input.name;
}

inline std::string mission_and(const std::string& more) {
  return kMission + more;
}

/// Instances of it are the tables of bad input.
class BadInputTest : public ::testing::TestWithParam<BadInput> {};

}  // namespace ironbird::scenarios
