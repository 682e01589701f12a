// What all figures over time share: the range, the phases of flight, the marks of events.

#include <algorithm>
#include <string_view>

#include "scenarios/record/topics.hpp"
#include "scenarios/report/figures.hpp"
#include "scenarios/report/flight_data.hpp"
#include "scenarios/report/replay_figures.hpp"

namespace ironbird::scenarios {

namespace {

/// The phases of the first run that has any.
std::vector<plot::Stretch> phases_of(const ReportRun& run) {
  std::vector<plot::Stretch> out;
  const Curve phase = curve_of(run, kFlightTopic, "phase");
  for (std::size_t i = 0; i < phase.time.size(); ++i) {
    const auto number = static_cast<std::size_t>(std::max(0.0, phase.value[i]));
    const auto names = enumerators(autopilot::FlightPhase{});
    const std::string name =
        number < names.size() ? std::string(names[number].second) : std::to_string(number);
    if (!out.empty()) out.back().to = phase.time[i];
    if (out.empty() || out.back().name != name) out.push_back({phase.time[i], phase.time[i], name, name});
  }
  return out;
}

/// Phases have their band; what the FCU or the planner says and pictures taken are in the table, not on every
/// axis.
bool has_mark(const RunEvent& event) {
  constexpr std::array<std::string_view, 6> kUnmarked{"phase", "health",   "arming",
                                                      "fcu",   "snapshot", "answer"};
  return std::find(kUnmarked.begin(), kUnmarked.end(), event.kind) == kUnmarked.end();
}

/// What stands at a mark. A distance or a refusal says what it is of; who reads the rest knows it by its
/// name.
std::string label_of(const RunEvent& event) {
  const auto is_kind = [&](std::string_view kind) { return kind == event.kind; };
  if (std::any_of(kPositionEvents.begin(), kPositionEvents.end(), is_kind))
    return event.kind + " " + event.text;
  if (event.kind == "refused") return "refused: " + event.text.substr(0, event.text.find(':'));
  if (event.kind == "request" && event.text == "take_off") return "take_off asked for";
  return event.text + (event.kind.ends_with("_end") ? " ends" : "");
}

}  // namespace

plot::TimeFrame time_frame(const std::vector<ReportRun>& runs) {
  plot::TimeFrame frame;
  for (const ReportRun& run : runs) {
    for (const char* topic : {kTruthTopic, kEstimateTopic, kTrajectoryTopic, kFlightTopic}) {
      const std::vector<double>& time = run.time(topic);
      if (time.empty()) continue;
      frame.range.include(time.front());
      frame.range.include(time.back());
    }
  }
  if (runs.empty()) return frame;
  // Our own controller only looks on in a flight that was recorded.
  frame.stretches = is_replay(runs.front()) ? recorded_phases(runs.front()) : phases_of(runs.front());
  for (const RunEvent& event : runs.front().events()) {
    if (!has_mark(event)) continue;
    const bool is_fault = event.kind.starts_with("fault") || event.kind == "gust" || event.text == "crashed";
    frame.marks.push_back(
        {event.time, event.kind + ": " + event.text, label_of(event), is_fault ? "fault" : ""});
  }
  return frame;
}

}  // namespace ironbird::scenarios
