#pragma once

#include <vector>

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// Does all runs, `at_once` of them at the same time in processes of their own. The results are in the order
/// of the jobs, whatever finished first.
std::vector<RunResult> run_jobs(const std::vector<RunJob>& jobs, const autopilot::Modules& modules,
                                int at_once, const Terminal& terminal);

}  // namespace ironbird::scenarios
