#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// The exit code of all runs together: interrupted outweighs an error, an error a failure, a failure what is
/// inconclusive.
int exit_code_of(const std::vector<RunResult>& results);

/// One line a run. Then, for each scenario that was flown several times, how many of its runs passed, and
/// least, median and greatest of each figure over its runs that have a valid
/// verdict.
std::string summary_text(const std::vector<RunResult>& results);

/// The middle of the values; of an even count the mean of the two in the middle. @param sorted  not empty
double median(std::span<const double> sorted);

/// A JSON array of the verdicts. A run without one gives an object with its scenario, seed, folder, exit code
/// and error; a verdict with an error beside it has the key "error" too.
std::string summary_json(const std::vector<RunResult>& results);

/// Writes the runs as JUnit XML. @throws UserError when the file cannot be written
void write_junit_file(const std::vector<RunResult>& results, const std::filesystem::path& file);

}  // namespace ironbird::scenarios
