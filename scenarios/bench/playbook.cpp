#include "scenarios/bench/playbook.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/window.hpp"

namespace ironbird::scenarios {

namespace {

/// Says of the whole run that the vehicle stays on the ground.
bool forbids_flight(const CheckConfig& check) {
  if (!check.none_of_events || !check.after.empty() || !check.until.empty()) return false;
  const std::string in_full = "ground:" + std::string(kLiftedOff);
  return std::any_of(check.none_of_events->begin(), check.none_of_events->end(),
                     [&](const std::string& name) { return name == kLiftedOff || name == in_full; });
}

/// Says that it happens.
bool expects(const CheckConfig& check, const RunEvent& event) {
  const auto means_it = [&](const std::string& name) { return is_called(event, name); };
  return (check.order_of_events &&
          std::any_of(check.order_of_events->begin(), check.order_of_events->end(), means_it)) ||
         means_it(Moment::read(check.after, "after").event) ||
         means_it(Moment::read(check.until, "until").event);
}

bool is_crash(const RunEvent& event) {
  return event.kind == "ground" && event.text == kCrashed;
}

/// How many crashes the check says there are. The name of the kind, `ground`, means none of them.
std::size_t expected_crashes(const CheckConfig& check) {
  const auto means_one = [](const std::string& name) {
    return name == kCrashed || name == "ground:" + std::string(kCrashed);
  };
  const auto in_order = !check.order_of_events ? 0
                                               : std::count_if(check.order_of_events->begin(),
                                                               check.order_of_events->end(), means_one);
  const bool in_window = means_one(Moment::read(check.after, "after").event) ||
                         means_one(Moment::read(check.until, "until").event);
  return std::max<std::size_t>(static_cast<std::size_t>(in_order), in_window ? 1 : 0);
}

/// The first crash of each flight: what has fallen may bounce and tumble.
std::vector<RunEvent> crashes(const std::vector<RunEvent>& events) {
  std::vector<RunEvent> found;
  bool new_flight = true;
  for (const RunEvent& event : events) {
    if (event.kind == "phase" && event.text == "take_off") new_flight = true;
    if (is_crash(event) && std::exchange(new_flight, false)) found.push_back(event);
  }
  return found;
}

/// The take-off that the pilot asks for by himself; a vehicle that takes off when it is armed needs none.
bool is_the_pilots_own(const RunEvent& refusal, const Scenario& scenario) {
  const double late = refusal.time - scenario.pilot.take_off_at;
  return scenario.pilot.automatic && refusal.text.starts_with("take_off:") &&
         std::abs(late) <= to_seconds(scenario.fcu.tick);
}

std::string about_refusal(const RunEvent& refusal) {
  return "request at " + with_unit(refusal.time, "s") + " was refused: " + refusal.text;
}

std::string name_it(std::string_view event) {
  return "let a check name it: order_of_events = [\"" + std::string(event) + "\"]";
}

std::string why_left(const Script::Left& left) {
  if (!left.due) return " waited for \"" + left.after + "\", which never happened";
  return " was due at " + with_unit(to_seconds(*left.due), "s") + ", when the run was over";
}

/// What is asked for when the run ends leaves nothing to be judged; a picture of the end is one.
Script::Role role_of(const Deed& deed) {
  if (deed.kind == Deed::Kind::kEnd) return Script::Role::kEnd;
  return deed.kind == Deed::Kind::kEvent ? Script::Role::kBeforeTheEnd : Script::Role::kIndifferent;
}

}  // namespace

void Playbook::add_scenario() {
  for (std::size_t i = 0; i < scenario_.events.size(); ++i) {
    add(scenario_.events[i].after, scenario_.events[i].at, {Deed::Kind::kEvent, i});
  }
  for (std::size_t i = 0; i < scenario_.snapshots.size(); ++i) {
    add(scenario_.snapshots[i].after, scenario_.snapshots[i].at, {Deed::Kind::kSnapshot, i});
  }
  add("", scenario_.duration, {Deed::Kind::kEnd, 0});
  if (!scenario_.end_after.empty()) add(scenario_.end_after, scenario_.end_delay, {Deed::Kind::kEnd, 0});
}

void Playbook::add(const std::string& after, double delay, Deed deed) {
  script_.add(after, from_seconds(delay), role_of(deed));
  deeds_.push_back(deed);
}

void Playbook::add_at(Time when, Deed deed) {
  script_.add("", when, role_of(deed));
  deeds_.push_back(deed);
}

std::optional<Deed> Playbook::next_due(Time now) {
  const auto item = script_.next_due(now);
  return item ? std::optional(deeds_[*item]) : std::nullopt;
}

void Playbook::hear(const RunEvent& event, Time now) {
  // A picture's name or a text of the FCU is no event of the flight.
  if (event.kind != "snapshot" && event.kind != "fcu") script_.happened(event.text, now);
  script_.happened(event.kind + ":" + event.text, now);
}

std::string Playbook::name_of(const Deed& deed) const {
  switch (deed.kind) {
    case Deed::Kind::kEvent:
      return "event \"" + describe_event(scenario_.events[deed.index]) + "\"";
    case Deed::Kind::kSnapshot:
      return "snapshot \"" + scenario_.snapshots[deed.index].name + "\"";
    case Deed::Kind::kEnd:
      return "the end of the run";
    default:
      return "";  // the bench's own
  }
}

std::vector<std::string> Playbook::gaps(const std::vector<RunEvent>& events) const {
  std::vector<std::string> gaps;
  const bool flew = std::any_of(events.begin(), events.end(), [](const RunEvent& event) {
    return event.kind == "ground" && event.text == kLiftedOff;
  });
  const auto& checks = scenario_.checks;
  if (!flew && std::none_of(checks.begin(), checks.end(), forbids_flight)) {
    gaps.push_back("the vehicle never left the ground; if it should not, say so: none_of_events = [\"" +
                   std::string(kLiftedOff) + "\"]");
  }
  for (const Script::Left& left : script_.left()) {
    const Deed& deed = deeds_[left.item];
    if (deed.kind == Deed::Kind::kEvent && !scenario_.events[deed.index].optional)
      gaps.push_back(name_of(deed) + why_left(left) + "; if it need not come, say so: optional = true");
  }
  const auto expected = [&](const RunEvent& event) {
    return std::any_of(checks.begin(), checks.end(),
                       [&](const auto& check) { return expects(check, event); });
  };
  for (const RunEvent& event : events) {
    if (event.kind == kRefusedEvent && !is_the_pilots_own(event, scenario_) && !expected(event))
      gaps.push_back(about_refusal(event) + "; if it should be, " +
                     name_it(std::string(kRefusedEvent) + ":" + event.text.substr(0, event.text.find(": "))));
  }
  std::size_t known = 0;
  for (const CheckConfig& check : checks) known = std::max(known, expected_crashes(check));
  const std::vector<RunEvent> fallen = crashes(events);
  for (std::size_t i = known; i < fallen.size(); ++i) {
    gaps.push_back("the vehicle crashed at " + with_unit(fallen[i].time, "s") + "; if it should, " +
                   name_it(kCrashed));
  }
  return gaps;
}

std::vector<std::string> Playbook::warnings(const std::vector<RunEvent>& events) const {
  std::vector<std::string> warnings;
  for (const Script::Left& left : script_.left()) {
    const Deed& deed = deeds_[left.item];
    const bool is_end = deed.kind == Deed::Kind::kEnd;
    if (deed.kind == Deed::Kind::kSnapshot)
      warnings.push_back(name_of(deed) + why_left(left) + ": not taken");
    if (is_end && !left.due) warnings.push_back(name_of(deed) + why_left(left));
  }
  for (const RunEvent& event : events) {
    if (event.kind == kRefusedEvent && is_the_pilots_own(event, scenario_))
      warnings.push_back(about_refusal(event));
  }
  return warnings;
}

}  // namespace ironbird::scenarios
