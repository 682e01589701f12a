#include "scenarios/app/run_job.hpp"

#include <cstdio>
#include <exception>
#include <system_error>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/products.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/requirements/verdict_json.hpp"
#include "scenarios/requirements/verdict_text.hpp"
#include "simulator/render/solid_layer.hpp"

namespace ironbird::scenarios {

namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw ConfigError(folder.string() + ": cannot make the output folder: " + error.message() +
                      "; choose another with --out");
}

Verdict fly(const RunJob& job, const autopilot::Modules& modules, const Terminal& terminal,
            bool& interrupted) {
  ProgressBar bar(terminal, job.loaded->name);
  const auto start = std::chrono::steady_clock::now();
  BenchOptions options;
  if (job.products.log) options.log_file = job.folder / "flight.mcap";
  options.on_progress = [&](const Progress& progress) {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    char text[64];
    std::snprintf(text, sizeof text, "%5.1f s flown, %4.0f x real time", progress.simulated,
                  elapsed > 0.0 ? progress.simulated / elapsed : 0.0);
    bar.show(progress.simulated, progress.duration, text);
    return !interrupt_requested();
  };
  Bench bench(*job.loaded, modules, std::move(options));
  Verdict verdict = bench.fly();
  interrupted = bench.interrupted();
  return verdict;
}

void tell(const Verdict& verdict, const Terminal& terminal) {
  const std::string text =
      terminal.interactive ? verdict_table(verdict, terminal.colour) : verdict_lines(verdict);
  std::fputs(text.c_str(), stderr);
}

/// Finds out before the flight, not after it, that it cannot be drawn.
void check_scene(const RunJob& job) {
  const std::filesystem::path& root = job.loaded->project_root;
  const Scenario& scenario = job.loaded->scenario;
  simulator::check_scene((root / scenario.vehicle_folder / "scene.xml").string(),
                         (root / scenario.field).string());
}

/// What an earlier run left in the folder must not be taken for this one's.
void remove_old_products(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* name : {"verdict.json", "report.html", "flight.mcap", "video.mp4"}) {
    std::filesystem::remove(folder / name, ignored);
  }
}

RunResult carry_out(const RunJob& job, const autopilot::Modules& modules, const Terminal& terminal) {
  if (job.products.video || job.products.snapshots) check_scene(job);
  make_folder(job.folder);
  remove_old_products(job.folder);
  bool interrupted = false;
  RunResult result{job.folder, fly(job, modules, terminal, interrupted), 0, {}};
  write_verdict(*result.verdict, job.folder / "verdict.json");
  tell(*result.verdict, terminal);
  result.exit_code = interrupted ? static_cast<int>(kExitInterrupted) : exit_code(result.verdict->outcome);
  if (!interrupted && !make_products(job, terminal)) result.exit_code = kExitInterrupted;
  return result;
}

}  // namespace

RunResult run_job(const RunJob& job, const autopilot::Modules& modules, const Terminal& terminal) {
  try {
    return carry_out(job, modules, terminal);
  } catch (const std::invalid_argument& error) {
    std::error_code not_empty;
    std::filesystem::remove(job.folder, not_empty);  // a folder without a result helps nobody
    return {job.folder, std::nullopt, kExitUsage, job.loaded->located(error).what()};
  } catch (const std::runtime_error& error) {
    return {job.folder, std::nullopt, kExitUsage, error.what()};
  } catch (const std::exception& error) {
    return {job.folder, std::nullopt, kExitInternal, error.what()};
  }
}

}  // namespace ironbird::scenarios
