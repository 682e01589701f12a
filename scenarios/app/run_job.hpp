#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "autopilot/modules.hpp"
#include "scenarios/app/run_listener.hpp"
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

/// What an operator says of a run on a real unit.
struct LiveWord {
  bool released = false;
  double meeting_patience = 5.0;    ///< s, until the unit has said who it is
  double verified_patience = 60.0;  ///< s, until all is as the scenario wants it, where nobody watches
};

/// Which run it is.
struct RunName {
  std::string scenario;               ///< file name without its ending
  std::optional<std::uint64_t> seed;  ///< when the scenario is flown with several
  std::filesystem::path folder;       ///< where its results are

  /// "three_waypoints", or "three_waypoints, seed 7"
  std::string text() const;
};

/// One run to do.
struct RunJob {
  RunName name;
  std::shared_ptr<const LoadedScenario> loaded;
  RunProducts products;
  LiveWord live;
};

/// What became of it.
struct RunResult {
  RunName name;
  std::optional<Verdict> verdict;  ///< none when the flight could not be done, or not to its end
  int exit_code = 0;
  std::string error;  ///< what could not be done and why, a line for each finding; may stand beside a verdict
};

/// Flies one scenario in this process and writes its folder. Errors become part of the result.
RunResult run_job(const RunJob& job, const autopilot::Modules& modules, RunListener& listener);

}  // namespace ironbird::scenarios
