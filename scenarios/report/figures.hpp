#pragma once

#include <string>
#include <vector>

#include "scenarios/report/plot/plane.hpp"
#include "scenarios/report/plot/time_stack.hpp"
#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// The figures of a report. With one run, colour tells truth, estimate and command apart; with several,
/// colour tells the runs apart and the dash tells what it is.
plot::TimeFrame time_frame(const std::vector<ReportRun>& runs);

plot::Plane path_from_above(const std::vector<ReportRun>& runs);
plot::TimeStack position_and_heading(const std::vector<ReportRun>& runs);
plot::TimeStack attitude_and_speed(const std::vector<ReportRun>& runs);
plot::TimeStack path_errors(const std::vector<ReportRun>& runs);
plot::TimeStack position_errors(const std::vector<ReportRun>& runs);
plot::TimeStack velocity_errors(const std::vector<ReportRun>& runs);
plot::TimeStack attitude_errors(const std::vector<ReportRun>& runs);
plot::TimeStack motors_and_battery(const std::vector<ReportRun>& runs);

}  // namespace ironbird::scenarios
