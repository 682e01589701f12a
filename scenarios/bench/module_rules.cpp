#include "scenarios/bench/module_rules.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "scenarios/config/nearest_name.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::ParameterSlot;
using autopilot::ParameterTable;

std::string suggestion(const std::string& wrong, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(wrong, names);
  return nearest.empty() ? "; there are: " + joined(names) : "; did you mean '" + nearest + "'?";
}

/// What is wrong with a value, or nothing.
std::string complaint(const ParameterSlot& slot, double value) {
  if (std::holds_alternative<bool*>(slot.value))
    return value == 0.0 || value == 1.0 ? "" : "must be 0 or 1, for false or true";
  if (std::holds_alternative<int*>(slot.value) && value != std::round(value)) return "must be a whole number";
  if (value >= slot.lower && value <= slot.upper) return "";
  std::ostringstream text;
  text << "must be between " << slot.lower << " and " << slot.upper;
  if (slot.unit != "1") text << " " << slot.unit;
  return text.str();
}

class ModuleRules {
 public:
  ModuleRules(const Scenario& scenario, const std::vector<SlotAccess>& slots)
      : scenario_(scenario), slots_(slots) {}

  std::vector<std::string> findings() {
    for (std::size_t i = 0; i < scenario_.events.size(); ++i) {
      const std::string path = "event[" + std::to_string(i) + "]";
      const EventConfig& event = scenario_.events[i];
      if (!event.swap.empty()) check_swap(path, event);
      if (!event.set.empty()) check_set(path, event);
    }
    return std::move(findings_);
  }

 private:
  const SlotAccess* find(const std::string& name) const {
    const auto found =
        std::find_if(slots_.begin(), slots_.end(), [&](const SlotAccess& s) { return s.name == name; });
    return found == slots_.end() ? nullptr : &*found;
  }

  std::vector<std::string> slot_names() const {
    std::vector<std::string> names;
    for (const SlotAccess& slot : slots_) names.push_back(slot.name);
    return names;
  }

  void check_swap(const std::string& path, const EventConfig& event) {
    const SlotAccess* slot = find(event.swap);
    if (slot == nullptr) {
      findings_.push_back(path + ".swap = \"" + event.swap + "\": there is no such slot" +
                          suggestion(event.swap, slot_names()));
      return;
    }
    const std::vector<std::string> kinds = slot->kinds();
    if (event.kind.empty() || std::find(kinds.begin(), kinds.end(), event.kind) != kinds.end()) return;
    findings_.push_back(path + ".kind = \"" + event.kind + "\": there is no such module for " + event.swap +
                        suggestion(event.kind, kinds));
  }

  void check_set(const std::string& path, const EventConfig& event) {
    const std::string named = event.set.substr(0, event.set.find('.'));
    const SlotAccess* slot = find(named);
    if (slot == nullptr) {
      findings_.push_back(path + ".set = \"" + event.set +
                          "\": must be slot and parameter, such as controller.max_roll; there is no slot '" +
                          named + "'" + suggestion(named, slot_names()));
      return;
    }
    std::vector<std::string> names;
    std::string wrong;
    for (const std::string& kind : kinds_in(*slot)) {
      ParameterTable parameters;
      const std::shared_ptr<void> module = slot->make(kind, parameters);
      for (const ParameterSlot& parameter : parameters.slots()) names.push_back(parameter.path);
      const ParameterSlot* parameter = parameters.find(event.set);
      if (parameter == nullptr) continue;
      wrong = complaint(*parameter, event.value);
      if (wrong.empty()) return;
    }
    if (wrong.empty()) {
      findings_.push_back(path + ".set = \"" + event.set + "\": there is no such parameter" +
                          suggestion(event.set, names));
    } else {
      findings_.push_back(path + ".value: of " + event.set + ", " + wrong);
    }
  }

  /// What the slot begins with and what events put into it.
  std::set<std::string> kinds_in(const SlotAccess& slot) const {
    std::set<std::string> kinds = {slot.slot->kind};
    for (const EventConfig& event : scenario_.events) {
      const std::vector<std::string> known = slot.kinds();
      if (event.swap == slot.name && std::find(known.begin(), known.end(), event.kind) != known.end())
        kinds.insert(event.kind);
    }
    return kinds;
  }

  const Scenario& scenario_;
  const std::vector<SlotAccess>& slots_;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> module_findings(const Scenario& scenario, const std::vector<SlotAccess>& slots) {
  return ModuleRules(scenario, slots).findings();
}

}  // namespace ironbird::scenarios
