#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/metrics.hpp"
#include "scenarios/requirements/outcome.hpp"
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

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("run", self.run, "", "what was run");
    visit("outcome", self.outcome, "1", "pass, fail, inconclusive or invalid");
    visit("reasons", self.reasons, "", "why it is not a pass, one line each");
    visit("warnings", self.warnings, "", "what did not go as the scenario says, one line each");
    visit("checks", self.checks, "", "what each check found");
    visit("metrics", self.metrics, "", "figures of the run");
    visit("events", self.events, "", "what happened, in order of time");
  }
};

/// Finds outcome and reasons: invalid if `broken_promises` names any, else the worst of the checks that
/// could be judged. A run without any is inconclusive: nothing was asked of it.
void conclude(Verdict& verdict, const std::vector<std::string>& broken_promises);

/// What the program returns for a run: 0 pass, 1 fail, 5 inconclusive or invalid.
int exit_code(Outcome outcome);

}  // namespace ironbird::scenarios
