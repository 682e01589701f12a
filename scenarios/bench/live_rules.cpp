#include "scenarios/bench/live_rules.hpp"

#include <algorithm>

#include "scenarios/bench/make_guard.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kNoTruth = "no truth on a real vehicle";

/// Metrics that are taken from the truth.
bool is_about_truth(const std::string& metric) {
  return metric.starts_with("true_") || metric.starts_with("estimate_");
}

bool names_truth(const std::string& text) {
  return text.starts_with("truth.") || text.find(" truth.") != std::string::npos;
}

}  // namespace

std::vector<std::string> live_findings(const LoadedScenario& loaded) {
  const Scenario& scenario = loaded.scenario;
  std::vector<std::string> findings;
  if (scenario.fcu.line.empty()) {
    findings.emplace_back(
        "fcu.line: must say where the unit is, as /dev/serial/by-id/NAME or udp:HOST[:PORT[:OWN_PORT]]");
  }
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    if (!scenario.events[i].fault) continue;
    findings.push_back("event[" + std::to_string(i) +
                       "].fault: only a simulator can break things; leave the event away, or fly fcu.kind = "
                       "\"virtual\"");
  }
  if (loaded.gives("environment.wind")) {
    findings.emplace_back(
        "environment.wind: only a simulator makes weather; leave it away, or fly fcu.kind = \"virtual\"");
  }
  if (loaded.gives("link")) {
    findings.emplace_back("link: a real line has faults of its own; these are for `ironbird fcu serve`");
  }
  if (!scenario.start.on_ground) {
    findings.emplace_back("start.on_ground = false: a real vehicle starts on the ground");
  }
  const auto timeout = std::chrono::milliseconds(unit_parameter(scenario, "OFFBOARD_TIMEOUT"));
  if (scenario.interlock.greatest_missed * scenario.fcu.tick > timeout / 2) {
    findings.push_back(
        "interlock.greatest_missed = " + std::to_string(scenario.interlock.greatest_missed) +
        ": so many control periods are longer than half of OFFBOARD_TIMEOUT, must be at most " +
        std::to_string(timeout / 2 / scenario.fcu.tick));
  }
  return findings;
}

std::vector<std::string> live_notes(const Scenario& scenario) {
  std::vector<std::string> notes;
  if (scenario.pilot.automatic) {
    notes.emplace_back(
        "the pilot arms and hands over when they like: pilot.arm_at and pilot.take_off_at are not used; the "
        "vehicle takes off when it is armed and handed over");
  }
  const auto hands = std::count_if(scenario.events.begin(), scenario.events.end(),
                                   [](const EventConfig& event) { return event.pilot.has_value(); });
  if (hands > 0) {
    notes.push_back(std::to_string(hands) +
                    (hands == 1 ? " event is the pilot's and is" : " events are the pilot's and are") +
                    " left to them");
  }
  return notes;
}

std::string why_not_judged(const CheckConfig& check) {
  const bool truth = names_truth(check.signal) || is_about_truth(check.metric) ||
                     names_truth(check.happens.value_or("")) ||
                     names_truth(check.never_happens.value_or("")) ||
                     std::any_of(check.error.begin(), check.error.end(), names_truth);
  return truth ? kNoTruth : "";
}

}  // namespace ironbird::scenarios
