#include "scenarios/bench/scenario_loader.hpp"

#include <algorithm>
#include <sstream>

#include "scenarios/bench/autopilot_loader.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/config/digest.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/config/toml_reader.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kVehicleFiles[] = {"vehicle.toml", "sensors.toml", "fcu.toml", "autopilot.toml"};

/// The path as a reader would write it: from the working folder when it lies below it.
std::filesystem::path readable(const std::filesystem::path& path) {
  const std::filesystem::path relative = path.lexically_relative(std::filesystem::current_path());
  return relative.empty() || *relative.begin() == ".." ? path : relative;
}

std::string vehicle_folder(const toml::table& scenario, const Overrides& overrides) {
  const toml::node* node = scenario.get("vehicle");
  if (node != nullptr && !node->is_string() && !node->is_table()) {
    throw ConfigError(location(node->source()) +
                      ": vehicle: must be the name of a folder, such as \"models/x650\"");
  }
  std::string folder = scenario["vehicle"].value_or(Scenario{}.vehicle_folder);
  for (const auto& [path, text] : overrides.settings) {
    if (path == "vehicle") folder = text;
  }
  return folder;
}

/// The vehicle's files, those that are there, merged.
toml::table load_vehicle(const std::filesystem::path& root, const std::string& folder,
                         const toml::table& scenario) {
  const std::filesystem::path place = root / folder;
  if (!std::filesystem::exists(place / "vehicle.toml")) {
    const toml::node* node = scenario.get("vehicle");
    const std::string where = node != nullptr ? location(node->source()) + ": " : std::string();
    throw ConfigError(where + "vehicle = \"" + folder + "\": " + readable(place / "vehicle.toml").string() +
                      " is not there; a vehicle is a folder like models/x650");
  }
  toml::table merged;
  for (const char* name : kVehicleFiles) {
    if (std::filesystem::exists(place / name)) merge_toml(merged, load_toml(readable(place / name), root));
  }
  return merged;
}

/// `[fcu.parameters] NAME = value` as the list that the virtual FCU takes.
void move_fcu_parameters(toml::table& root) {
  toml::table* fcu = root["fcu"].as_table();
  toml::table* parameters = fcu == nullptr ? nullptr : (*fcu)["parameters"].as_table();
  if (parameters == nullptr) return;
  toml::array list;
  for (auto& [name, value] : *parameters) {
    toml::table entry;
    entry.insert("name", std::string(name.str()));
    entry.insert("value", std::move(value));
    list.push_back(std::move(entry));
  }
  fcu->insert_or_assign("parameters", std::move(list));
}

void note_places(const toml::table& table, const std::string& prefix, LoadedScenario& loaded) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix.empty() ? std::string(key.str()) : prefix + "." + std::string(key.str());
    loaded.places.emplace_back(path, location(node.source()));
    if (const toml::table* inner = node.as_table()) note_places(*inner, path, loaded);
    if (const toml::array* array = node.as_array()) {
      for (std::size_t i = 0; i < array->size(); ++i) {
        if (const toml::table* element = array->get(i)->as_table()) {
          note_places(*element, path + "[" + std::to_string(i) + "]", loaded);
        }
      }
    }
  }
}

/// `vehicle` names the folder in a scenario and is a table in the folder's files: here it is the table. It is
/// taken out of `root`, not copied, because a copy of a node forgets its place in the file.
void read_scenario(toml::table& root, LoadedScenario& loaded) {
  Scenario& scenario = loaded.scenario;
  TomlReader reader;
  if (const toml::table* vehicle = root["vehicle"].as_table())
    reader.read(*vehicle, scenario.vehicle, "vehicle");
  root.erase("vehicle");
  reader.read(root, scenario, "", {"autopilot", "include"});
  reader.finish();
}

}  // namespace

const ModuleSettings* LoadedScenario::settings_of(const std::string& slot, const std::string& kind) const {
  const auto found = std::find_if(modules.begin(), modules.end(),
                                  [&](const ModuleSettings& m) { return m.slot == slot && m.kind == kind; });
  return found == modules.end() ? nullptr : &*found;
}

std::string LoadedScenario::own_place(const std::string& path, const std::string& place) const {
  const std::string own = file.string() + ":";
  if (place.starts_with(own)) return place;
  const auto inside = std::find_if(places.begin(), places.end(), [&](const auto& p) {
    return p.first.starts_with(path + ".") && p.second.starts_with(own);
  });
  return inside == places.end() ? place : inside->second;
}

ConfigError LoadedScenario::located(const std::invalid_argument& error) const {
  const std::string text = error.what();
  std::string path = text.substr(0, text.find_first_of(" :="));
  while (!path.empty()) {
    const auto found =
        std::find_if(places.begin(), places.end(), [&](const auto& p) { return p.first == path; });
    if (found != places.end()) return ConfigError(own_place(path, found->second) + ": " + text);
    const std::size_t cut = path.find_last_of(".[");
    path = cut == std::string::npos ? std::string() : path.substr(0, cut);
  }
  return ConfigError(readable(file).string() + ": " + text);
}

std::filesystem::path find_project_root(const std::filesystem::path& file) {
  for (const std::filesystem::path& start :
       {std::filesystem::absolute(file).parent_path(), std::filesystem::current_path()}) {
    for (std::filesystem::path folder = start;; folder = folder.parent_path()) {
      if (std::filesystem::is_directory(folder / "models")) return folder;
      if (folder == folder.root_path()) break;
    }
  }
  return std::filesystem::current_path();
}

LoadedScenario load_scenario(const std::filesystem::path& file, const Overrides& overrides,
                             const autopilot::Modules& modules) {
  LoadedScenario loaded;
  loaded.file = file;
  loaded.name = file.stem().string();
  loaded.project_root = find_project_root(file);
  toml::table scenario = load_toml(file, loaded.project_root);
  const std::string folder = vehicle_folder(scenario, overrides);
  toml::table root = load_vehicle(loaded.project_root, folder, scenario);
  // `vehicle` may be the folder's name, or a table of values that win over those of the default folder.
  if (!scenario["vehicle"].is_table()) scenario.erase("vehicle");
  merge_toml(root, std::move(scenario));
  for (const auto& [path, text] : overrides.settings) {
    if (path != "vehicle") set_value(root, path, text);
  }
  if (overrides.seed) root.insert_or_assign("seed", static_cast<std::int64_t>(*overrides.seed));
  note_places(root, "", loaded);
  std::ostringstream effective;
  effective << "vehicle_folder = \"" << folder << "\"\n" << root;
  loaded.effective_config = effective.str();
  loaded.digest = digest(loaded.effective_config);
  move_fcu_parameters(root);
  loaded.scenario.vehicle_folder = folder;
  read_scenario(root, loaded);
  check_rules(loaded);
  load_autopilot(root, modules, loaded);
  return loaded;
}

}  // namespace ironbird::scenarios
