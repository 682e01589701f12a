#include "scenarios/bench/scenario_loader.hpp"

#include <algorithm>
#include <system_error>

#include "scenarios/bench/autopilot_loader.hpp"
#include "scenarios/bench/fcu_loader.hpp"
#include "scenarios/bench/hil_rules.hpp"
#include "scenarios/bench/model_files.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/config/digest.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kVehicleFiles[] = {kVehicleFile, "sensors.toml", "fcu.toml", "autopilot.toml"};

/// Under which the effective configuration tells the vehicle's folder: its files are merged into the rest.
constexpr const char* kVehicleFolder = "vehicle_folder";

bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

using Folders = std::vector<std::filesystem::path>;

/// The folders in which a name is looked for that the configuration gives at this place: an option's word is
/// first taken from the working folder, as a shell does.
Folders folders_for(const std::filesystem::path& scenario, const toml::node* node) {
  const auto* source = node == nullptr ? nullptr : node->source().path.get();
  const bool by_option = source != nullptr && source->starts_with("--set ");
  Folders folders =
      search_folders(source == nullptr || by_option ? scenario : std::filesystem::path(*source));
  if (by_option) folders.insert(folders.begin(), std::filesystem::current_path());
  return folders;
}

/// The vehicle's folder as the scenario or the command line names it.
struct VehicleFolder {
  std::string name;
  std::string place;  ///< that says so; empty for the default
  Folders folders;    ///< to look in
};

VehicleFolder vehicle_folder(const std::filesystem::path& file, const toml::table& scenario,
                             const Overrides& overrides) {
  const toml::node* node = scenario.get("vehicle");
  VehicleFolder folder{Scenario{}.vehicle_folder, "", folders_for(file, node)};
  if (node != nullptr && !node->is_table()) {
    folder.place = place_of(*node);
    if (!node->is_string()) {
      throw ConfigError(
          folder.place +
          ": vehicle: must be the name of a folder, such as vehicle = \"models/x650\", or a table "
          "of values that differ from those of that folder, written [vehicle]");
    }
    folder.name = node->as_string()->get();
  }
  for (const auto& [path, text] : overrides.settings) {
    if (path != "vehicle") continue;
    folder = {text, "--set vehicle=" + text, search_folders(file)};
    folder.folders.insert(folder.folders.begin(), std::filesystem::current_path());
  }
  return folder;
}

/// The vehicle's files, merged. All are needed: flying with other sensors than meant would look like a
/// success.
toml::table load_vehicle(const VehicleFolder& folder, std::filesystem::path& place) {
  const std::string what =
      folder.place + (folder.place.empty() ? "" : ": ") + "vehicle = \"" + folder.name + "\": ";
  place = find_vehicle(folder.name, folder.folders);
  if (place.empty()) {
    throw ConfigError(what + "there is no folder of this name with a " + kVehicleFile + " in " +
                      folder.folders.front().string() + ", in a folder above it or in Ironbird's tree; " +
                      vehicles_in(folder.folders));
  }
  toml::table merged;
  for (const char* name : kVehicleFiles) {
    if (!is_there(place / name)) {
      throw ConfigError(what + "there is no " + readable(place / name).string() +
                        "; an empty file takes the defaults");
    }
    merge_toml(merged, load_toml(readable(place / name)));
  }
  return merged;
}

void apply_overrides(toml::table& root, const Overrides& overrides) {
  for (const auto& [path, text] : overrides.settings) {
    if (path == "vehicle") continue;  // was needed before the vehicle's files could be read
    if (path == "include" || path.starts_with("include[")) {
      throw ConfigError(
          "--set " + path + "=" + text +
          ": only a file can include others; write one that includes both, or set single values");
    }
    set_value(root, path, text);
  }
  if (overrides.seed) set_value(root, "seed", std::to_string(*overrides.seed));
}

/// Notes where `node`, which has this path, and everything below it come from.
void note_places(const toml::node& node, const std::string& path, LoadedScenario& loaded) {
  if (!path.empty()) loaded.places.emplace(path, place_of(node));
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, inner] : *table)
      note_places(inner, (path.empty() ? "" : path + ".") + std::string(key.str()), loaded);
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i)
      note_places(*array->get(i), path + "[" + std::to_string(i) + "]", loaded);
  }
}

/// Notes what the configuration is as a whole.
void note_configuration(const toml::table& root, const std::string& vehicle_folder, LoadedScenario& loaded) {
  note_places(root, "", loaded);
  loaded.effective_config =
      print_toml(toml::table{{kVehicleFolder, vehicle_folder}}) + "\n" + print_toml(root);
  loaded.digest = digest(loaded.effective_config);
  loaded.scenario.vehicle_folder = vehicle_folder;
}

/// `vehicle` names the folder in a scenario and is a table in the folder's files: here it is the table. It is
/// taken out of `root`, not copied, because a copy of a node forgets its place in the file.
std::vector<std::string> read_scenario(toml::table& root, Scenario& scenario) {
  std::vector<std::string> findings;
  take_fcu_parameters(root, scenario.fcu, findings);
  TomlReader reader;
  if (const toml::node* vehicle = root.get("vehicle"))
    reader.read_value(*vehicle, scenario.vehicle, {}, "vehicle");
  root.erase("vehicle");
  reader.read(root, scenario, "", {"autopilot"});
  findings.insert(findings.end(), reader.findings().begin(), reader.findings().end());
  return findings;
}

}  // namespace

const ModuleSettings* LoadedScenario::settings_of(const std::string& slot, const std::string& kind) const {
  const auto found = std::find_if(modules.begin(), modules.end(),
                                  [&](const ModuleSettings& m) { return m.slot == slot && m.kind == kind; });
  return found == modules.end() ? nullptr : &*found;
}

std::string LoadedScenario::own_place(const std::string& path, const std::string& place) const {
  const auto is_own = [&](const std::string& p) {
    return p.starts_with(file.string() + ":") || p.starts_with("--set ");
  };
  if (is_own(place)) return place;
  for (auto at = places.lower_bound(path + "."); at != places.end() && at->first.starts_with(path + ".");
       ++at) {
    if (is_own(at->second)) return at->second;
  }
  return place;
}

std::string LoadedScenario::located(const std::string& finding) const {
  std::string path = finding.substr(0, finding.find_first_of(" :="));
  while (!path.empty()) {
    const auto found = places.find(path);
    if (found != places.end()) return own_place(path, found->second) + ": " + finding;
    const std::size_t cut = path.find_last_of(".[");
    path = cut == std::string::npos ? std::string() : path.substr(0, cut);
  }
  return readable(file).string() + ":1:1: " + finding;  // about something that is nowhere
}

LoadedScenario load_scenario(const std::filesystem::path& file, const Overrides& overrides,
                             const autopilot::Modules& modules) {
  LoadedScenario loaded;
  loaded.file = file;
  loaded.name = file.stem().string();
  if (loaded.name == "." || loaded.name == "..") {
    throw ConfigError(file.string() + ": a run's folder has its scenario's name, and " + loaded.name +
                      " is none; rename the file");
  }
  toml::table scenario = load_toml(file);
  const VehicleFolder folder = vehicle_folder(file, scenario, overrides);
  toml::table root = load_vehicle(folder, loaded.vehicle_path);
  // `vehicle` may be the folder's name, or a table of values that win over those of the default folder.
  if (!scenario["vehicle"].is_table()) scenario.erase("vehicle");
  merge_toml(root, std::move(scenario));
  apply_overrides(root, overrides);
  note_configuration(root, folder.name, loaded);
  if (!folder.place.empty()) loaded.places.insert_or_assign("vehicle", folder.place);
  loaded.field_folders = folders_for(file, root.get("field"));
  std::vector<std::string> findings = read_scenario(root, loaded.scenario);
  loaded.field_path = find_field(loaded.scenario.field, loaded.field_folders);
  // A rule would only repeat what is wrong with a value that could not be read.
  if (findings.empty()) findings = rule_findings(loaded);
  const std::vector<std::string> more = load_autopilot(root, modules, loaded);
  findings.insert(findings.end(), more.begin(), more.end());
  const std::vector<std::string> loops = loop_findings(loaded);
  findings.insert(findings.end(), loops.begin(), loops.end());
  if (!findings.empty()) throw ConfigError(findings);
  return loaded;
}

LoadedScenario load_flown(const std::filesystem::path& log, const std::string& configuration,
                          const Overrides& overrides, const autopilot::Modules& modules) {
  LoadedScenario loaded;
  loaded.file = log;
  loaded.name = log.stem().string();
  toml::table root = parse_toml(configuration, log.string() + ", its configuration");
  const std::string folder = root[kVehicleFolder].value_or(std::string());
  root.erase(kVehicleFolder);
  for (const auto& [path, text] : overrides.settings) {
    if (path == "vehicle")
      throw ConfigError("vehicle = \"" + text +
                        "\": the vehicle of a flight that was flown is the log's; name another autopilot's "
                        "scenario with --scenario");
  }
  apply_overrides(root, overrides);
  note_configuration(root, folder, loaded);
  loaded.field_folders = search_folders(log);
  loaded.vehicle_path = find_vehicle(folder, loaded.field_folders);
  std::vector<std::string> findings = read_scenario(root, loaded.scenario);
  loaded.field_path = find_field(loaded.scenario.field, loaded.field_folders);
  const std::vector<std::string> more = load_autopilot(root, modules, loaded);
  findings.insert(findings.end(), more.begin(), more.end());
  if (!findings.empty()) throw ConfigError(findings);
  return loaded;
}

}  // namespace ironbird::scenarios
