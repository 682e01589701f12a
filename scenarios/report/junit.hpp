#pragma once

#include <string>
#include <vector>

#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// The verdicts as JUnit XML: one suite per run, one case per check; what is inconclusive or invalid is an
/// error, not a failure. The time of a suite is the simulated time.
std::string junit_xml(const std::vector<Verdict>& verdicts);

/// One line per check that does not pass, in the form that GitHub shows beside a change.
/// @param file  the scenario file of each verdict, relative to the repository
std::string annotations(const std::vector<Verdict>& verdicts, const std::vector<std::string>& files);

}  // namespace ironbird::scenarios
