#include "scenarios/app/scene.hpp"

#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/app/scene_text.hpp"
#include "scenarios/bench/model_files.hpp"
#include "scenarios/config/file_search.hpp"
#include "scenarios/config/user_error.hpp"
#include "simulator/render/solid_layer.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kSceneFile = "scene.xml";

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

/// Without symbolic links, as the engine wants them.
SceneFiles real(const SceneFiles& scene) {
  std::error_code ignored;
  const auto real_path = [&](const std::filesystem::path& path) {
    return path.empty() ? path : std::filesystem::weakly_canonical(path, ignored);
  };
  return {real_path(scene.vehicle), real_path(scene.field)};
}

/// What the log says about its run under `key`, or else what a scenario has that says nothing.
std::string run_text(const Log& log, const char* key, const std::string& otherwise) {
  const auto run = log.metadata().find("run");
  if (run == log.metadata().end()) return otherwise;
  const auto value = run->second.find(key);
  return value == run->second.end() || value->second.empty() ? otherwise : value->second;
}

}  // namespace

SceneFiles scene_of(const LoadedScenario& loaded) {
  return real({loaded.vehicle_path / kSceneFile, loaded.field_path});
}

SceneFiles scene_of(const Log& log, const std::filesystem::path& log_file) {
  const std::vector<std::filesystem::path> folders = search_folders(log_file);
  const std::string vehicle = run_text(log, "vehicle", Scenario{}.vehicle_folder);
  const std::string field = run_text(log, "field", Scenario{}.field);
  const SceneFiles scene = real({find_vehicle(vehicle, folders) / kSceneFile, find_field(field, folders)});
  const auto refuse = [&](const std::string& which) {
    throw UserError(
        log_file.string() + ": the " + which +
        " that was flown is not found from the log's folder or the working folder upwards; start in "
        "the folder of the scenario");
  };
  if (!is_file(scene.vehicle)) refuse("scene of the vehicle \"" + vehicle + "\"");
  if (scene.field.empty()) refuse("field \"" + field + "\"");
  return scene;
}

bool has_scene(const LoadedScenario& loaded) {
  return !loaded.field_path.empty() && is_file(scene_of(loaded).vehicle);
}

void check_scene(const LoadedScenario& loaded) {
  const SceneFiles scene = scene_of(loaded);
  const std::string of_vehicle = "vehicle = \"" + loaded.scenario.vehicle_folder + "\": cannot be drawn: ";
  const std::string of_field = "field = \"" + loaded.scenario.field + "\": cannot be drawn: ";
  if (!is_file(scene.vehicle))
    throw ConfigError(loaded.located(of_vehicle + "there is no " + scene.vehicle.string()));
  if (scene.field.empty())
    throw ConfigError(loaded.located(of_field + "there is no such file; " + fields_in(loaded.field_folders)));
  std::vector<std::string> findings;
  for (const auto& [file, lead] : {std::pair{scene.vehicle, of_vehicle}, std::pair{scene.field, of_field}}) {
    for (const std::string& missing : SceneText(file).missing_files(scene.vehicle.parent_path()))
      findings.push_back(loaded.located(lead + missing));
  }
  if (!findings.empty()) throw ConfigError(findings);
  try {
    simulator::check_scene(scene.vehicle.string(), scene.field.string());
  } catch (const std::invalid_argument& error) {
    const std::string wrong = error.what();
    const bool by_vehicle = wrong.starts_with(scene.vehicle.string());
    const std::filesystem::path& file = by_vehicle ? scene.vehicle : scene.field;
    throw ConfigError(loaded.located((by_vehicle ? of_vehicle : of_field) +
                                     SceneText(file).located(wrong.substr(file.string().size() + 2))));
  }
}

}  // namespace ironbird::scenarios
