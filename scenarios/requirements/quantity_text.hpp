#pragma once

#include <string>
#include <string_view>

namespace ironbird::scenarios {

/// The number that a text such as `25 deg`, `1.5` or `300 ms` stands for, in `unit`.
/// @param unit  the unit wanted; a bare number is taken to be in it
/// @param what  what is being read, for the message
/// @throws std::invalid_argument naming `what`, the text and the unit when it is no number or has another
/// unit
double read_quantity(std::string_view text, std::string_view unit, const std::string& what);

}  // namespace ironbird::scenarios
