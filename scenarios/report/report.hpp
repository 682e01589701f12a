#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// One self-contained HTML page about the runs: verdicts first, then figures, then tables. It loads nothing
/// from anywhere, opens from disk and prints. Depends on nothing but the runs: the same runs give the same
/// bytes.
///
/// With several runs the figures overlay them; phases and event marks are those of the first.
std::string report_html(const std::vector<ReportRun>& runs);

/// Writes the page. @throws std::runtime_error naming the file when it cannot be written
void write_report(const std::vector<ReportRun>& runs, const std::filesystem::path& file);

}  // namespace ironbird::scenarios
