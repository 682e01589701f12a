#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace ironbird::scenarios {

/// What became of a check or of a run.
enum class Outcome : std::uint8_t {
  kPass,
  kFail,
  kInconclusive,  ///< what should have been judged did not occur
  kInvalid,       ///< the bench broke one of its own promises: nothing can be said
  kNotJudged      ///< a check that this wiring cannot judge; never of a run
};

constexpr std::array<std::pair<Outcome, std::string_view>, 5> enumerators(Outcome) {
  return {{{Outcome::kPass, "pass"},
           {Outcome::kFail, "fail"},
           {Outcome::kInconclusive, "inconclusive"},
           {Outcome::kInvalid, "invalid"},
           {Outcome::kNotJudged, "not judged"}}};
}

constexpr std::string_view name_of(Outcome outcome) {
  for (const auto& [value, name] : enumerators(outcome)) {
    if (value == outcome) return name;
  }
  return "invalid";
}

}  // namespace ironbird::scenarios
