#pragma once

#include <string>
#include <vector>

#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// The head of the page for one run: the verdict in large letters, what was run, the reasons, the key
/// figures.
std::string verdict_section(const ReportRun& run);

/// Every check with its margin. Empty without a verdict. @param labelled  say which run it is about
std::string checks_table(const ReportRun& run, bool labelled);

/// The metrics of all runs side by side.
std::string metrics_table(const std::vector<ReportRun>& runs);

std::string events_table(const ReportRun& run, bool labelled);

/// The effective configuration and the other entries of the metadata record "run".
std::string configuration_section(const ReportRun& run);

}  // namespace ironbird::scenarios
