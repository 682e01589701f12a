#include "scenarios/bench/playbook.hpp"

#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

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
  script_.add(after, from_seconds(delay));
  deeds_.push_back(deed);
}

void Playbook::add_at(Time when, Deed deed) {
  script_.add("", when);
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

std::vector<std::string> Playbook::warnings(const std::vector<RunEvent>& events) const {
  std::vector<std::string> warnings;
  for (const Script::Left& left : script_.left()) {
    const Deed& deed = deeds_[left.item];
    const std::string name = name_of(deed);
    if (name.empty()) continue;
    if (!left.due) {
      warnings.push_back(name + " waited for \"" + left.after + "\", which never happened");
    } else if (deed.kind != Deed::Kind::kEnd) {
      warnings.push_back(name + " was due at " + with_unit(to_seconds(*left.due), "s") +
                         ", after the end of the run");
    }
  }
  for (const RunEvent& event : events) {
    if (event.kind == "refused") {
      warnings.push_back("request at " + with_unit(event.time, "s") + " was refused: " + event.text);
    }
  }
  return warnings;
}

}  // namespace ironbird::scenarios
