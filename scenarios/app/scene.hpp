#pragma once

#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {

/// What pictures of a run are drawn from: absolute paths without symbolic links.
struct SceneFiles {
  std::filesystem::path vehicle;  ///< scene.xml in the vehicle's folder
  std::filesystem::path field;
};

/// The files of a scenario. They need not be there.
SceneFiles scene_of(const LoadedScenario& loaded);

/// The files of a log, whose names are looked for from the log's folder on.
/// @throws UserError naming the one that is not found
SceneFiles scene_of(const Log& log, const std::filesystem::path& log_file);

/// Does the vehicle's folder hold a scene, and does the scenario name a field? Without them it can be flown
/// but not drawn.
bool has_scene(const LoadedScenario& loaded);

/// Finds out before the flight, not after it, that it cannot be drawn.
/// @throws ConfigError naming the file that is missing or wrong
void check_scene(const LoadedScenario& loaded);

}  // namespace ironbird::scenarios
