#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// How many letters have to be added, removed, replaced or swapped with their neighbour to turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that was probably meant: the nearest by edit distance, of equals the first. Empty when none is
/// near.
std::string nearest_name(std::string_view wrong, std::span<const std::string> known);

}  // namespace ironbird::scenarios
