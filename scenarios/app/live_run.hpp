#pragma once

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// Flies one scenario on the unit at the other end of its line: the control loop in a thread of its own, this
/// one for the operator.
/// @param interrupted  set when Ctrl-C ended it
/// @throws transport::LinkError when the unit is not there, or not the one that the scenario wants
Verdict fly_live(const RunJob& job, const autopilot::Modules& modules, RunListener& listener,
                 bool& interrupted);

/// Refuses runs on a real unit that nobody has released or can release, that are not alone, or that ask for
/// pictures. @throws ConfigError
void check_live_jobs(const std::vector<RunJob>& jobs);

}  // namespace ironbird::scenarios
