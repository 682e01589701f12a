#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "autopilot/modules.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// What a run leaves behind, beside the verdict.
struct RunProducts {
  bool log = true;
  bool report = true;
  bool video = false;
  bool preview = false;
  bool snapshots = false;
};

/// One run to do.
struct RunJob {
  std::shared_ptr<const LoadedScenario> loaded;
  std::filesystem::path folder;
  RunProducts products;
};

/// What became of it.
struct RunResult {
  std::filesystem::path folder;
  std::optional<Verdict> verdict;  ///< none when the run could not be done
  int exit_code = 0;
  std::string error;  ///< why not, one line
};

/// Flies one scenario in this process, writes its folder and tells the terminal. Errors become part of the
/// result.
RunResult run_job(const RunJob& job, const autopilot::Modules& modules, const Terminal& terminal);

}  // namespace ironbird::scenarios
