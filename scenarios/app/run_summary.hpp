#pragma once

#include <string>
#include <vector>

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// The exit code of all runs together: interrupted outweighs an error, an error a failure, a failure what is
/// inconclusive.
int exit_code_of(const std::vector<RunResult>& results);

/// One line a run and, for several runs of one scenario, the worst value of each metric.
std::string summary_text(const std::vector<RunResult>& results, const Terminal& terminal);

/// A JSON array of the verdicts; a run without one gives an object with its error.
std::string summary_json(const std::vector<RunResult>& results);

}  // namespace ironbird::scenarios
