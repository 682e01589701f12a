#pragma once

#include <string>
#include <vector>

#include "scenarios/report/plot/plane.hpp"
#include "scenarios/report/plot/time_stack.hpp"
#include "scenarios/report/report_run.hpp"

namespace ironbird::scenarios {

/// Is this the log of a recorded flight that was replayed?
bool is_replay(const ReportRun& run);

/// What the recorder's own autopilot was doing, by what it was told to do in flight. Empty: nobody recorded
/// it.
std::vector<plot::Stretch> recorded_phases(const ReportRun& run);

// The figures of such logs: the estimate that was made anew beside the recorded one and the receiver's fixes.
// ROScopter paper, results, its last experiment. With several runs colour tells them apart; the recorded one
// is the first run's.
plot::Plane replayed_path(const std::vector<ReportRun>& runs);
plot::TimeStack replayed_position(const std::vector<ReportRun>& runs);
plot::TimeStack replayed_velocity(const std::vector<ReportRun>& runs);
plot::TimeStack replayed_attitude(const std::vector<ReportRun>& runs);
/// Ours less the recorded one, within three of our sigmas.
plot::TimeStack replayed_differences(const std::vector<ReportRun>& runs);
/// How the measurements fitted: innovations, the gates that they have to pass, and which were refused. Of
/// axes that are judged together the gate is the reach of the ellipse: what is beyond it is refused for
/// certain.
plot::TimeStack replayed_innovations(const std::vector<ReportRun>& runs);
/// Biases of gyro, accelerometer and compass as far as they are estimated, within three sigmas.
plot::TimeStack replayed_biases(const std::vector<ReportRun>& runs);

}  // namespace ironbird::scenarios
