#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scenarios/app/command_line.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/failure.hpp"
#include "scenarios/app/live_run.hpp"
#include "scenarios/app/run_job.hpp"
#include "scenarios/app/run_jobs.hpp"
#include "scenarios/app/run_summary.hpp"
#include "scenarios/app/scenario_arguments.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/video/video_sink.hpp"

namespace ironbird::scenarios {

namespace {

struct RunArguments {
  ScenarioArguments scenarios;
  std::string out = "out";
  std::string junit;
  int jobs = 1;
  bool json = false;
  RunProducts products;
  LiveWord live;
  bool no_log = false;
  bool no_report = false;
};

/// What the command line asks for: runs that can be done, and scenarios that cannot be flown at all.
struct Plan {
  std::vector<RunJob> jobs;
  std::vector<RunResult> refused;
};

/// The runs of one scenario. @throws std::exception when it cannot be loaded
std::vector<RunJob> jobs_of(const std::string& file, const std::vector<std::uint64_t>& seeds,
                            const RunArguments& arguments, const autopilot::Modules& modules) {
  Overrides overrides{split_settings(arguments.scenarios.settings), std::nullopt};
  std::vector<RunJob> jobs;
  const std::size_t count = std::max<std::size_t>(1, seeds.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (!seeds.empty()) overrides.seed = seeds[i];
    auto loaded = std::make_shared<const LoadedScenario>(load_scenario(file, overrides, modules));
    RunName name{loaded->name, std::nullopt, std::filesystem::path(arguments.out) / loaded->name};
    if (seeds.size() > 1) {
      name.seed = seeds[i];
      name.folder /= "seed_" + std::to_string(seeds[i]);
    }
    jobs.push_back({std::move(name), std::move(loaded), arguments.products, arguments.live});
  }
  return jobs;
}

/// A scenario that cannot be loaded does not keep the others from flying.
Plan make_plan(const RunArguments& arguments, const autopilot::Modules& modules) {
  const std::vector<std::uint64_t> seeds = parse_seeds(arguments.scenarios.seeds);
  split_settings(
      arguments.scenarios.settings);  // what is wrong with these is wrong once, not with every scenario
  Plan plan;
  for (const std::string& file : arguments.scenarios.files) {
    try {
      for (RunJob& job : jobs_of(file, seeds, arguments, modules)) plan.jobs.push_back(std::move(job));
    } catch (const std::exception& error) {
      const Failure failure = failure_of(error);
      const std::string name = std::filesystem::path(file).stem().string();
      plan.refused.push_back({{name, std::nullopt, std::filesystem::path(arguments.out) / name},
                              std::nullopt,
                              failure.exit_code,
                              failure.text});
    }
  }
  return plan;
}

/// Two scenarios of the same file name would write over each other.
void check_folders(const std::vector<RunJob>& jobs) {
  std::set<std::filesystem::path> folders;
  for (const RunJob& job : jobs) {
    if (!folders.insert(job.name.folder.lexically_normal()).second) {
      throw ConfigError(job.name.folder.string() +
                        ": two of the scenarios would write here; fly them apart, with another --out");
    }
  }
}

void check_arguments(const RunArguments& arguments) {
  if (!arguments.products.log && (arguments.products.video || arguments.products.snapshots)) {
    throw ConfigError("--no-log: film and snapshots are made from the log; leave one of the options away");
  }
  if (arguments.products.video) check_encoder();
  if (arguments.out.empty()) throw ConfigError("--out: must name a folder");
}

/// Writes the file before the flights: now is the time to learn that it cannot be written, and if the program
/// should be ended by force, it says so.
void write_first_junit_file(const Plan& plan, const std::filesystem::path& file) {
  std::vector<RunResult> results = plan.refused;
  for (const RunJob& job : plan.jobs) {
    results.push_back({job.name, std::nullopt, kExitInterrupted, "the program ended before this run did"});
  }
  write_junit_file(results, file);
}

int run(RunArguments arguments, const autopilot::Modules& modules) {
  arguments.products.log = !arguments.no_log;
  arguments.products.report = !arguments.no_report && !arguments.no_log;
  check_arguments(arguments);
  Plan plan = make_plan(arguments, modules);
  check_folders(plan.jobs);
  check_live_jobs(plan.jobs);
  if (!arguments.junit.empty()) write_first_junit_file(plan, arguments.junit);
  for (const RunResult& result : plan.refused) tell_error(result);
  std::vector<RunResult> results = std::move(plan.refused);
  for (RunResult& result : run_jobs(plan.jobs, modules, arguments.jobs, Terminal::of_standard_error())) {
    results.push_back(std::move(result));
  }
  if (!arguments.junit.empty()) write_junit_file(results, arguments.junit);
  if (arguments.json) std::fputs(summary_json(results).c_str(), stdout);
  if (results.size() > 1) std::fputs(summary_text(results).c_str(), stderr);
  return exit_code_of(results);
}

}  // namespace

Verb run_verb() {
  return {"run", "fly scenarios and judge them", [](VerbOptions& options) {
            auto arguments = std::make_shared<RunArguments>();
            add_scenario_arguments(options, arguments->scenarios);
            options.option("--out", arguments->out, "folder for the results").shows_default();
            options.option("--jobs", arguments->jobs, "runs at the same time, each in a process of its own")
                .within(1, 256)
                .shows_default();
            options.flag("--video", arguments->products.video, "make video.mp4");
            options.flag("--preview", arguments->products.preview,
                         "with --video: quicker and plainer pictures");
            options.flag("--snapshots", arguments->products.snapshots,
                         "make the pictures that the scenario names");
            options.flag("--no-log", arguments->no_log, "write no log and no report, only the verdict");
            options.flag("--no-report", arguments->no_report, "write no report");
            options.option("--junit", arguments->junit, "write a JUnit file for a build server");
            options.flag("--release", arguments->live.released,
                         "with fcu.kind = serial: the operator's word that the unit may be flown");
            options
                .option("--patience", arguments->live.meeting_patience,
                        "with fcu.kind = serial: how long to wait for the unit, s")
                .within(0.1, 3600.0)
                .shows_default();
            options.flag("--json", arguments->json, "verdicts as JSON on standard output");
            options.footer(
                "Examples:\n"
                "  ironbird run scenarios/library/paper/three_waypoints.toml --video\n"
                "  ironbird run scenarios/library/weather/*.toml --jobs 2 --seed 1:20\n"
                "  ironbird run scenarios/library/paper/three_waypoints.toml --set plant.engine=ode\n"
                "  ironbird run scenarios/library/paper/three_waypoints.toml --set "
                "autopilot.estimator.kind=error_state");
            return [arguments](const autopilot::Modules& modules) { return run(*arguments, modules); };
          }};
}

}  // namespace ironbird::scenarios
