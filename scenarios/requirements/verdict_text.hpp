#pragma once

#include <cstddef>
#include <string>

#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// The verdict for a terminal: aligned columns, one line per check, the reasons below. Ends with a line feed.
/// @param colour   with the colour codes of a terminal
/// @param columns  of the terminal; longer explanations are broken there, and on a narrow terminal each check
/// gets
///                 lines of its own. 0: nothing is broken
std::string verdict_table(const Verdict& verdict, bool colour, std::size_t columns = 0);

/// The verdict for a log of continuous integration: one plain line per check, then one for the run.
std::string verdict_lines(const Verdict& verdict);

}  // namespace ironbird::scenarios
