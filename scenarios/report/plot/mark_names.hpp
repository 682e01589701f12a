#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ironbird::scenarios::plot {

/// Width of a name in the face of the drawings, px, on the safe side.
double width_of(std::string_view name);

/// A name that wants to stand at a mark.
struct MarkName {
  double x = 0.0;      ///< px, of the mark
  double width = 0.0;  ///< px, of the name and what parts it from the mark
  bool first = false;  ///< placed before the others, for example a fault
  std::string text;
};

/// Where a name stands.
struct NamePlace {
  std::size_t row = 0;  ///< 0: the lowest
  bool before = false;  ///< left of its mark instead of right of it
};

/// The places of all names, in the order of the names; nothing for those that have no room.
struct MarkNames {
  std::vector<std::optional<NamePlace>> places;
  std::size_t rows = 1;
};

/// Finds each name a place: right of its mark or left of it, in up to four rows, between `left` and `right`.
/// No two names of a row come nearer than a gap.
MarkNames placed(const std::vector<MarkName>& names, double left, double right);

}  // namespace ironbird::scenarios::plot
