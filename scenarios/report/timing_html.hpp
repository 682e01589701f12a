#pragma once

#include <string>

#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// How the bench kept its time, with a histogram of each stage. Empty for a run that was not flown in real
/// time.
std::string timing_section(const ReportRun& run);

}  // namespace ironbird::scenarios
