#pragma once

#include <vector>

#include "scenarios/app/run_job.hpp"
#include "scenarios/app/terminal.hpp"

namespace ironbird::scenarios {

/// Does all runs, `at_once` of them at the same time, and tells the terminal. One at a time they are flown in
/// this process and each shows its verdict in full; several at a time have processes of their own, and each
/// tells in one line how it ended, followed by the checks that do not hold. An interrupt reaches all of them.
/// The results are in the order of the jobs, whatever finished first.
std::vector<RunResult> run_jobs(const std::vector<RunJob>& jobs, const autopilot::Modules& modules,
                                int at_once, const Terminal& terminal);

/// Says on standard error what could not be done, each line with the name of the run.
void tell_error(const RunResult& result);

}  // namespace ironbird::scenarios
