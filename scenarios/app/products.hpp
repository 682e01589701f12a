#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/app/run_job.hpp"
#include "scenarios/app/scene.hpp"
#include "scenarios/record/log.hpp"
#include "scenarios/video/film_script.hpp"

namespace ironbird::scenarios {

/// What the scenario that a log was flown with says about pictures, read back from the log itself.
struct PicturePlan {
  std::vector<CameraConfig> cameras;
  std::vector<CutConfig> cuts;
  std::vector<SnapshotConfig> snapshots;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("camera", self.cameras, "", "fixed cameras");
    visit("cut", self.cuts, "", "when the film changes cameras");
    visit("snapshot", self.snapshots, "", "pictures to take");
  }
};

/// @throws ConfigError when the log does not hold its configuration
PicturePlan picture_plan(const Log& log);

/// The film of a log as its scenario wants it. @param preview  quicker and plainer pictures
FilmScript plan_film(const Log& log, const PicturePlan& plan, const SceneFiles& scene, bool preview);

/// Draws the film. @return false when it was interrupted
bool make_video(const Log& log, const SceneFiles& scene, const std::filesystem::path& file, bool preview,
                RunListener& listener);

/// Takes the pictures that the scenario names. @return the files written
std::vector<std::filesystem::path> make_snapshots(const Log& log, const SceneFiles& scene,
                                                  const std::filesystem::path& folder, RunListener& listener);

/// Makes what the job asks for from the log of a finished run: report, snapshots, film.
/// @return false when the user interrupted it
/// @throws UserError naming the file that could not be made
bool make_products(const RunJob& job, RunListener& listener);

}  // namespace ironbird::scenarios
