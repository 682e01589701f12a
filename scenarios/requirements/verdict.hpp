#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/requirements/bench_timing.hpp"
#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/metrics.hpp"
#include "scenarios/requirements/outcome.hpp"
#include "scenarios/requirements/replayed_flight.hpp"
#include "scenarios/requirements/timeline.hpp"

namespace ironbird::scenarios {

/// What was run.
struct RunIdentity {
  std::string scenario;
  std::string title;
  std::uint64_t seed = 0;
  std::string digest;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("scenario", self.scenario, "", "short name of the scenario");
    visit("title", self.title, "", "what it shows");
    visit("seed", self.seed, "1", "of every random stream");
    visit("digest", self.digest, "", "of the effective configuration");
  }
};

/// The judgement of one run.
struct Verdict {
  RunIdentity run;
  Outcome outcome = Outcome::kInconclusive;
  std::vector<std::string> reasons;
  std::vector<std::string> warnings;
  std::vector<CheckResult> checks;
  std::vector<Metric> metrics;
  std::vector<RunEvent> events;
  std::optional<BenchTiming> timing = {};
  std::optional<ReplayedFlight> flight = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("run", self.run, "", "what was run");
    visit("outcome", self.outcome, "1", "pass, fail, inconclusive or invalid");
    visit("reasons", self.reasons, "", "why it is not a pass, one line each");
    visit("warnings", self.warnings, "", "what did not go as the scenario says, one line each");
    visit("checks", self.checks, "", "what each check found");
    visit("metrics", self.metrics, "", "figures of the run");
    visit("events", self.events, "", "what happened, in order of time");
    visit("timing", self.timing, "", "how the bench kept its time; of runs in real time");
    visit("flight", self.flight, "", "the recorded flight that was replayed; of replays");
  }
};

/// What is wrong with a run as a whole, whatever its checks find.
struct RunFlaws {
  std::vector<std::string> broken_promises;
  std::vector<std::string> gaps;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("broken_promises", self.broken_promises, "", "what the bench failed to keep, one line each");
    visit("gaps", self.gaps, "", "what the scenario says and did not happen, one line each");
  }
};

/// Finds outcome and reasons: invalid if a promise was broken, else the worst of the checks that could be
/// judged. A run without any is inconclusive, nothing was asked of it; so is a run with a gap that its checks
/// pass: it did not show what its scenario is about.
void conclude(Verdict& verdict, const RunFlaws& flaws);

/// The reasons that no check gives: broken promises, gaps, that there are no checks.
std::vector<std::string> reasons_of_the_run(const Verdict& verdict);

/// What the program returns for a run: 0 pass, 1 fail, 5 inconclusive or invalid.
int exit_code(Outcome outcome);

}  // namespace ironbird::scenarios
