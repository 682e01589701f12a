#include "scenarios/app/scene.hpp"

#include <stdexcept>
#include <system_error>

#include "simulator/render/solid_layer.hpp"

namespace ironbird::scenarios {

namespace {

std::filesystem::path scene_of(const LoadedScenario& loaded) {
  return loaded.project_root / loaded.scenario.vehicle_folder / "scene.xml";
}

}  // namespace

bool has_scene(const LoadedScenario& loaded) {
  std::error_code ignored;
  return !loaded.scenario.field.empty() && std::filesystem::exists(scene_of(loaded), ignored);
}

void check_scene(const LoadedScenario& loaded) {
  const std::filesystem::path scene = scene_of(loaded);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(scene, ignored)) {
    throw ConfigError(loaded.located("vehicle = \"" + loaded.scenario.vehicle_folder +
                                     "\": cannot be drawn: there is no " + scene.string()));
  }
  try {
    simulator::check_scene(scene.string(), (loaded.project_root / loaded.scenario.field).string());
  } catch (const std::invalid_argument& error) {
    const std::string wrong = error.what();
    const std::string which = wrong.starts_with(scene.string())
                                  ? "vehicle = \"" + loaded.scenario.vehicle_folder
                                  : "field = \"" + loaded.scenario.field;
    throw ConfigError(loaded.located(which + "\": cannot be drawn: " + wrong));
  }
}

}  // namespace ironbird::scenarios
