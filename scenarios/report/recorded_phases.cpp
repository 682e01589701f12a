// What the recorder's own autopilot was doing: the band over the figures of a recorded flight.

#include <algorithm>

#include "scenarios/record/topics.hpp"
#include "scenarios/report/replay_figures.hpp"

namespace ironbird::scenarios {

namespace {

/// The tint of a phase in flight, one of those of our own.
std::string style_of_phase(const std::string& name) {
  if (name == "take-off" || name == "hold") return "take_off";
  if (name == "land" || name == "precision land" || name == "descend") return "landing";
  return "offboard";
}

}  // namespace

std::vector<plot::Stretch> recorded_phases(const ReportRun& run) {
  std::vector<plot::Stretch> out;
  const LogTopic* const topic = run.log().topic(kRecordedPhaseTopic);
  if (topic == nullptr || topic->time().empty()) return out;
  const std::vector<double>& armed = run.column(kRecordedPhaseTopic, "armed");
  const std::vector<double>& airborne = run.column(kRecordedPhaseTopic, "airborne");
  const std::vector<std::string>& modes = topic->texts("mode");
  for (std::size_t k = 0; k < std::min({armed.size(), airborne.size(), modes.size()}); ++k) {
    const double since = topic->time()[k];
    if (!out.empty()) out.back().to = since;
    const std::string name = airborne[k] > 0.5 ? (modes[k].empty() ? "airborne" : modes[k])
                             : armed[k] > 0.5  ? "on the ground"
                                               : "disarmed";
    if (out.empty() || out.back().name != name)
      out.push_back({since, since, name, airborne[k] > 0.5 ? style_of_phase(name) : ""});
  }
  const std::vector<double>& estimates = run.time(kEstimateTopic);
  if (!out.empty() && !estimates.empty()) out.back().to = std::max(out.back().to, estimates.back());
  return out;
}

}  // namespace ironbird::scenarios
