#pragma once

#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "autopilot/signals.hpp"
#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/metrics.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// Watches one run and judges it. Sees only const structs and changes nothing.
///
/// Order of a tick: the bench reports its own events, then calls observe().
class Judge {
 public:
  using Time = std::chrono::nanoseconds;

  /// @param signals  every struct that checks may name; outlives the judge
  /// @param sources  what the metrics are taken from; outlive the judge
  /// @param tick     time between two calls of observe(), > 0
  /// @param not_judged  for each check the reason why it cannot be judged, or empty; shorter: the rest can
  /// @throws std::invalid_argument naming the check that does not fit
  Judge(const std::vector<CheckConfig>& checks, const SignalTable& signals, RunMetrics::Sources sources,
        Time tick, std::vector<std::string> not_judged = {});

  /// Reports something that happened outside the autopilot, for example the beginning of a fault.
  void event(Time now, std::string kind, std::string text);

  /// To be called after every tick, in order of time.
  void observe(Time now);

  /// All events so far, the judge's own (phases, arming, waypoints, health) among them.
  const std::vector<RunEvent>& events() const { return timeline_.events(); }

  /// @param wall_seconds  time that the run took, s; 0: unknown
  Verdict finish(const RunIdentity& run, const RunFlaws& flaws, double wall_seconds);

 private:
  RunMetrics metrics_;
  EventDetector detector_;
  Timeline timeline_;
  /// A check, or what is said of one that cannot be judged.
  std::vector<std::variant<Check, CheckResult>> checks_;
};

}  // namespace ironbird::scenarios
