#include "scenarios/app/run_job.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <system_error>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/live_run.hpp"
#include "scenarios/app/products.hpp"
#include "scenarios/app/run_folder.hpp"
#include "scenarios/app/scene.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/config/write_file.hpp"
#include "scenarios/record/output_file.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

Verdict fly_simulated(const RunJob& job, const autopilot::Modules& modules, RunListener& listener,
                      bool& interrupted) {
  const auto start = std::chrono::steady_clock::now();
  BenchOptions options;
  options.released = job.live.released;
  if (job.products.log) options.log_file = job.name.folder / "flight.mcap";
  options.on_progress = [&](const Progress& progress) {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    char text[64];
    std::snprintf(text, sizeof text, "%5.1f s flown, %4.0f x real time", progress.simulated,
                  elapsed > 0.0 ? progress.simulated / elapsed : 0.0);
    listener.progress({job.name.text(), progress.simulated, progress.expected_end, text});
    return true;
  };
  options.stop_wanted = interrupt_requested;
  Bench bench(*job.loaded, modules, std::move(options));
  Verdict verdict = bench.fly();
  interrupted = bench.interrupted();
  return verdict;
}

Verdict fly(const RunJob& job, const autopilot::Modules& modules, RunListener& listener, bool& interrupted) {
  const bool live = job.loaded->scenario.fcu.kind == FcuKind::kSerial;
  return (live ? fly_live : fly_simulated)(job, modules, listener, interrupted);
}

/// Does the run and fills `result` as far as it comes.
void carry_out(const RunJob& job, const autopilot::Modules& modules, RunListener& listener,
               RunResult& result) {
  const std::filesystem::path& folder = job.name.folder;
  if (job.products.video || job.products.snapshots) check_scene(*job.loaded);
  // A run that cannot be wired leaves the results of an earlier one alone.
  const bool own_unit = job.loaded->scenario.fcu.has_own_unit();
  if (own_unit) const Bench possible(*job.loaded, modules, {});
  const RunFolder held(folder);
  remove_old_products(folder);
  bool interrupted = false;
  try {
    result.verdict = fly(job, modules, listener, interrupted);
  } catch (const WriteError&) {
    // Half a log would be taken for a flight, on a disk that needs room, and this one can be flown again.
    // What a real unit has done cannot.
    std::error_code ignored;
    if (own_unit) std::filesystem::remove(folder / "flight.mcap", ignored);
    throw;
  }
  write_verdict(*result.verdict, folder / "verdict.json");
  listener.judged(*result.verdict);
  result.exit_code = interrupted ? static_cast<int>(kExitInterrupted) : exit_code(result.verdict->outcome);
  if (interrupted || make_products(job, listener)) return;
  result.exit_code = kExitInterrupted;
  result.error = "the run was flown, but interrupted before its film was ready";
}

void note_failure(const std::exception& error, RunResult& result) {
  const Failure failure = failure_of(error);
  result.exit_code = failure.exit_code;
  result.error = failure.text;
}

}  // namespace

std::string RunName::text() const {
  return seed ? scenario + ", seed " + std::to_string(*seed) : scenario;
}

RunResult run_job(const RunJob& job, const autopilot::Modules& modules, RunListener& listener) {
  RunResult result{job.name, std::nullopt, kExitInternal, {}};
  try {
    carry_out(job, modules, listener, result);
  } catch (const std::invalid_argument& error) {
    note_failure(job.loaded->located(error), result);
  } catch (const std::exception& error) {
    note_failure(error, result);
  }
  return result;
}

}  // namespace ironbird::scenarios
