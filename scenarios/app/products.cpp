#include "scenarios/app/products.hpp"

#include <limits>
#include <utility>

#include "scenarios/app/interrupt.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/config/include.hpp"
#include "scenarios/config/toml_reader.hpp"
#include "scenarios/config/write_file.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/report/report.hpp"
#include "scenarios/video/film.hpp"
#include "scenarios/video/png.hpp"
#include "scenarios/video/replay_film.hpp"

namespace ironbird::scenarios {

namespace {

simulator::Vector3 vector(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<NamedCamera> cameras_of(const PicturePlan& plan) {
  std::vector<NamedCamera> cameras;
  for (const CameraConfig& camera : plan.cameras) {
    cameras.push_back({camera.name, {vector(camera.p_N), vector(camera.target_N), camera.field_of_view}});
  }
  return cameras;
}

/// When the bench reported that this snapshot was due, s; NaN when it never was.
double time_of_snapshot(const Log& log, const std::string& name) {
  const LogTopic* events = log.topic(kEventTopic);
  if (events == nullptr) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < events->time().size(); ++i) {
    if (events->texts("kind")[i] == "snapshot" && events->texts("text")[i] == picture_event(name))
      return events->time()[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

FilmOptions film_options(const PicturePlan& plan, const SceneFiles& scene) {
  FilmOptions options;
  options.vehicle_scene = scene.vehicle;
  options.field = scene.field;
  options.cameras = cameras_of(plan);
  for (const CutConfig& cut : plan.cuts) options.cuts.push_back({cut.at, cut.camera});
  return options;
}

}  // namespace

PicturePlan picture_plan(const Log& log) {
  const auto run = log.metadata().find("run");
  if (run == log.metadata().end() && log.truncated())
    throw ConfigError("the log was cut short before its scenario: nothing can be drawn from it");
  if (run == log.metadata().end() || !run->second.contains("config")) {
    throw ConfigError("the log does not hold its scenario: it was not written by `ironbird run`");
  }
  const toml::table config = parse_toml(run->second.at("config"), "configuration in the log");
  PicturePlan plan;
  toml::table pictures;
  for (const char* key : {"camera", "cut", "snapshot"}) {
    if (const toml::node* node = config.get(key)) pictures.insert(key, *node);
  }
  read_toml(pictures, plan);
  return plan;
}

FilmScript plan_film(const Log& log, const PicturePlan& plan, const SceneFiles& scene, bool preview) {
  FilmOptions options = film_options(plan, scene);
  if (preview) options.quality = simulator::Quality::kPreview;
  return is_replayed(log) ? replay_film_script(log, options) : film_script(log, options);
}

bool make_video(const Log& log, const SceneFiles& scene, const std::filesystem::path& file, bool preview,
                RunListener& listener) {
  const FilmScript script = plan_film(log, picture_plan(log), scene, preview);
  return film_to_file(script, file, 0, [&](std::size_t done, std::size_t all) {
    listener.progress(
        {"film", static_cast<double>(done), static_cast<double>(all), std::to_string(done) + " pictures"});
    return !interrupt_requested();
  });
}

std::vector<std::filesystem::path> make_snapshots(const Log& log, const SceneFiles& scene,
                                                  const std::filesystem::path& folder,
                                                  RunListener& listener) {
  const PicturePlan plan = picture_plan(log);
  if (plan.snapshots.empty()) listener.note("no picture was taken: the scenario has no [[snapshot]]");
  std::vector<std::filesystem::path> files;
  for (const SnapshotConfig& snapshot : plan.snapshots) {
    const double time = time_of_snapshot(log, snapshot.name);
    if (!(time == time)) {
      listener.note("snapshot " + snapshot.name + ": its moment never came");
      continue;
    }
    FilmOptions options = film_options(plan, scene);
    options.quality = simulator::Quality::kStill;
    options.cuts = {{0.0, snapshot.camera}};
    const FilmScript script = film_script(log, options);
    const simulator::Image picture = stills(script, {frame_at(script, time)}).front();
    make_folder(folder);
    files.push_back(folder / (snapshot.name + ".png"));
    write_png(picture, files.back());
  }
  return files;
}

bool make_products(const RunJob& job, RunListener& listener) {
  if (!job.products.log) return true;
  const std::filesystem::path log_file = job.name.folder / "flight.mcap";
  if (job.products.report) {
    std::vector<ReportRun> runs;
    runs.push_back(ReportRun::read(job.name.text(), log_file, job.name.folder / "verdict.json"));
    write_report(runs, job.name.folder / "report.html");
  }
  if (!job.products.video && !job.products.snapshots) return true;
  const Log log = Log::read(log_file);
  if (job.products.snapshots)
    make_snapshots(log, scene_of(*job.loaded), job.name.folder / "snapshots", listener);
  if (!job.products.video) return true;
  return make_video(log, scene_of(*job.loaded), job.name.folder / "video.mp4", job.products.preview,
                    listener);
}

}  // namespace ironbird::scenarios
