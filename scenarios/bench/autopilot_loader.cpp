#include "scenarios/bench/autopilot_loader.hpp"

#include <algorithm>

#include "scenarios/bench/autopilot_slots.hpp"
#include "scenarios/bench/module_rules.hpp"
#include "scenarios/bench/tick_rules.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::ParameterSlot;
using autopilot::ParameterTable;
using autopilot::ParameterValue;

class AutopilotReader {
 public:
  AutopilotReader(const toml::table& root, LoadedScenario& loaded) : root_(root), loaded_(loaded) {}

  void read(SlotAccess& access) {
    const toml::node* node = root_["autopilot"][access.name].node();
    const toml::table* table = node == nullptr ? nullptr : node->as_table();
    if (node != nullptr && table == nullptr) report_no_slot(*node, access);
    if (table != nullptr) read_slot(*table, access);
    const std::vector<std::string> kinds = access.kinds();
    if (std::find(kinds.begin(), kinds.end(), access.slot->kind) == kinds.end()) {
      return report("autopilot." + access.name + ".kind = \"" + access.slot->kind +
                    "\": there is no such module; there are: " + joined(kinds) +
                    meant(access.slot->kind, kinds));
    }
    for (const std::string& kind : kinds) {
      ParameterTable parameters;
      const std::shared_ptr<void> module = access.make(kind, parameters);
      ModuleSettings settings{access.name, kind, {}};
      set_environment(parameters, access.name, settings);
      const std::string kind_path = "autopilot.kinds." + kind;
      const toml::node* own = root_["autopilot"]["kinds"][kind].node();
      if (own != nullptr && own->is_table()) {
        read_parameters(*own->as_table(), kind_path, access.name, parameters, settings, {});
      } else if (own != nullptr) {
        report(kind_path + ": must be a table of parameters, written [" + kind_path + "]");
      }
      if (table != nullptr && kind == access.slot->kind) {
        read_parameters(*table, "autopilot." + access.name, access.name, parameters, settings,
                        {"kind", "period"});
      }
      if (const std::string conflict = parameters.set_all(settings.values); !conflict.empty()) {
        report("autopilot." + conflict + (kind == access.slot->kind ? "" : " (in " + kind_path + ")"));
      }
      loaded_.modules.push_back(std::move(settings));
    }
  }

  /// Tables that no slot and no kind has read.
  void report_unknown(const std::vector<SlotAccess>& slots) {
    const toml::node* node = root_.get("autopilot");
    if (node == nullptr) return;
    const toml::table* all = node->as_table();
    if (all == nullptr) return report("autopilot: must be a table, written [autopilot.estimator] and so on");
    std::vector<std::string> names = {"kinds"};
    std::vector<std::string> kinds;
    for (const SlotAccess& slot : slots) {
      names.push_back(slot.name);
      for (const std::string& kind : slot.kinds()) kinds.push_back(kind);
    }
    report_strangers(*all, "autopilot", names);
    const toml::node* tables = all->get("kinds");
    if (tables == nullptr) return;
    if (!tables->is_table())
      return report("autopilot.kinds: must be a table of tables, written [autopilot.kinds.KIND]");
    report_strangers(*tables->as_table(), "autopilot.kinds", kinds);
  }

  void check_events(const std::vector<SlotAccess>& slots) {
    for (const std::string& finding : module_findings(loaded_.scenario, slots)) {
      const std::string path = finding.substr(0, finding.find_first_of(" :="));
      // That a value is missing is said elsewhere.
      if (!path.ends_with(".value") || loaded_.gives(path)) report(finding);
    }
  }

  std::vector<std::string> findings() { return std::move(findings_); }

 private:
  void report_no_slot(const toml::node& node, const SlotAccess& access) {
    const std::string header = "[autopilot." + access.name + "]";
    const std::string kind = node.is_string() ? node.as_string()->get() : access.slot->kind;
    report("autopilot." + access.name + ": must be a table, written " + header + " and below it kind = \"" +
           kind + "\"");
  }

  static std::string meant(const std::string& wrong, const std::vector<std::string>& names) {
    const std::string nearest = nearest_name(wrong, names);
    return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
  }

  void read_slot(const toml::table& table, const SlotAccess& access) {
    TomlReader reader;
    const std::string path = "autopilot." + access.name;
    if (const toml::node* kind = table.get("kind"))
      reader.read_value(*kind, access.slot->kind, {""}, path + ".kind");
    if (const toml::node* period = table.get("period")) {
      reader.read_value(*period, access.slot->period, {"ns", 0.0, 1e10}, path + ".period");
      check_period(access.slot->period, path);
    }
    take(reader);
  }

  void check_period(autopilot::Time period, const std::string& path) {
    const auto tick = loaded_.scenario.fcu.tick;
    if (tick.count() <= 0 || period.count() % tick.count() == 0) return;
    const std::string shown = path + ".period = " + in_milliseconds(period);
    if (tick_is_to_blame(loaded_, path + ".period")) {
      return report("fcu.tick = " + in_milliseconds(tick) + ": must divide " + shown + " (" +
                    loaded_.places.at(path + ".period") + ")");
    }
    const autopilot::Time below = period / tick * tick;
    report(shown + ": must be a multiple of the tick; the nearest are " + in_milliseconds(below) + " and " +
           in_milliseconds(below + tick));
  }

  void set_environment(ParameterTable& parameters, const std::string& slot, ModuleSettings& settings) {
    const simulator::EnvironmentParams& environment = loaded_.scenario.environment;
    const std::pair<const char*, double> site[] = {
        {"gravity", environment.gravity}, {"mag.declination", environment.magnetic_field.declination}};
    for (const auto& [name, value] : site) {
      const std::string path = slot + "." + name;
      if (parameters.find(path) != nullptr) settings.values.emplace_back(path, value);
    }
  }

  void read_parameters(const toml::table& table, const std::string& shown, const std::string& path,
                       const ParameterTable& parameters, ModuleSettings& settings,
                       const std::vector<std::string>& also_known) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(also_known.begin(), also_known.end(), name) != also_known.end()) continue;
      const std::string full = path + "." + name;
      const toml::table* inner = node.as_table();
      const bool is_group = has_group(parameters, full);
      if (const ParameterSlot* slot = parameters.find(full)) {
        settings.values.emplace_back(full, read_value(node, *slot, shown + "." + name));
      } else if (is_group && inner != nullptr) {
        read_parameters(*inner, shown + "." + name, full, parameters, settings, {});
      } else if (is_group) {
        report(shown + "." + name + ": is a group of parameters, written [" + shown + "." + name + "]");
      } else {
        report_unknown_parameter(shown + "." + name, full, settings, parameters);
      }
    }
  }

  static bool has_group(const ParameterTable& parameters, const std::string& path) {
    return std::any_of(parameters.slots().begin(), parameters.slots().end(),
                       [&](const ParameterSlot& slot) { return slot.path.starts_with(path + "."); });
  }

  ParameterValue read_value(const toml::node& node, const ParameterSlot& slot, const std::string& path) {
    TomlReader reader;
    const Allowed allowed{slot.unit, slot.lower, slot.upper};
    ParameterValue value =
        std::visit([](const auto* current) { return ParameterValue(*current); }, slot.value);
    std::visit([&](auto& typed) { reader.read_value(node, typed, allowed, path); }, value);
    take(reader);
    return value;
  }

  void report_unknown_parameter(const std::string& shown, const std::string& full,
                                const ModuleSettings& settings, const ParameterTable& parameters) {
    std::vector<std::string> names;
    for (const ParameterSlot& slot : parameters.slots()) names.push_back(slot.path);
    std::string text = shown + ": module \"" + settings.kind + "\" has no such parameter";
    const std::string nearest = nearest_name(full, names);
    if (!nearest.empty()) text += "; did you mean '" + nearest.substr(settings.slot.size() + 1) + "'?";
    report(text);
  }

  void report_strangers(const toml::table& table, const std::string& path,
                        const std::vector<std::string>& names) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      const std::string known = nearest_name(name, names).empty() ? "; there are: " + joined(names) : "";
      report(path + "." + name + ": unknown key" + known + meant(name, names));
    }
  }

  void take(const TomlReader& reader) {
    findings_.insert(findings_.end(), reader.findings().begin(), reader.findings().end());
  }

  void report(const std::string& finding) { findings_.push_back(loaded_.located(finding)); }

  const toml::table& root_;
  LoadedScenario& loaded_;
  std::vector<std::string> findings_;
};

}  // namespace

namespace {

/// Estimators that fly on poses from outside: the virtual FCU sends none.
std::vector<std::string> poses_from_outside(const autopilot::Modules& modules, const LoadedScenario& loaded) {
  const auto needs_poses = [&](const std::string& kind) {
    const std::unique_ptr<autopilot::Estimator> estimator = modules.estimators.make(kind);
    return estimator != nullptr && estimator->needs_external_pose();
  };
  std::vector<std::string> findings;
  const auto report = [&](const std::string& path, const std::string& kind) {
    const std::string finding = path + " = \"" + kind +
                                "\": flies on poses from outside, and nothing in this bench sends any; "
                                "take \"ekf\" or \"error_state\"";
    findings.push_back(loaded.located(finding));
  };
  const std::string& first = loaded.autopilot.estimator.kind;
  if (needs_poses(first)) report("autopilot.estimator.kind", first);
  const auto& events = loaded.scenario.events;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].swap == "estimator" && needs_poses(events[i].kind)) {
      report("event[" + std::to_string(i) + "].kind", events[i].kind);
    }
  }
  return findings;
}

}  // namespace

std::vector<std::string> load_autopilot(const toml::table& root, const autopilot::Modules& modules,
                                        LoadedScenario& loaded) {
  std::vector<SlotAccess> slots = all_slots(loaded.autopilot, modules);
  AutopilotReader reader(root, loaded);
  for (SlotAccess& slot : slots) reader.read(slot);
  reader.report_unknown(slots);
  reader.check_events(slots);
  std::vector<std::string> findings = reader.findings();
  const std::vector<std::string> poses = poses_from_outside(modules, loaded);
  findings.insert(findings.end(), poses.begin(), poses.end());
  return findings;
}

}  // namespace ironbird::scenarios
