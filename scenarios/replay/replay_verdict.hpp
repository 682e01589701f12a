#pragma once

#include <string>
#include <vector>

#include "scenarios/replay/replay.hpp"
#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// A figure that must not be greater than this.
struct ReplayBound {
  std::string metric;
  double most = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("metric", self.metric, "", "name of the figure");
    visit("most", self.most, "SI", "greatest value that passes, in the figure's unit");
  }
};

/// "NAME=VALUE". @throws ConfigError for what is none, or no figure of a replay
ReplayBound parse_replay_bound(const std::string& text);

/// Judges a replay: the estimator has to start, and must not lose the estimate for good; bounds have to hold.
Verdict judge_replay(const ReplayResult& result, const RunIdentity& run,
                     const std::vector<ReplayBound>& bounds);

}  // namespace ironbird::scenarios
