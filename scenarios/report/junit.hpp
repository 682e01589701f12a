#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// One run as a build server sees it.
struct JunitRun {
  std::string name;
  std::optional<Verdict> verdict;
  std::string error;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "which run, unique among them");
    visit("verdict", self.verdict, "", "none when the flight could not be done");
    visit("error", self.error, "", "what could not be done; empty when nothing");
  }
};

/// The runs as JUnit XML: one suite per run, one case per check; what is inconclusive or invalid is an error,
/// not a failure. A run without a verdict, or with an error beside it, has the case "the run", an error. The
/// time of a suite is the simulated time.
std::string junit_xml(const std::vector<JunitRun>& runs);

}  // namespace ironbird::scenarios
