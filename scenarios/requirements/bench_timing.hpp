#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ironbird::scenarios {

/// How long something took, of all the times that it was done in a run.
struct DurationCounts {
  std::string name;
  std::string meaning;
  std::uint64_t count = 0;
  double p50 = 0.0;
  double p99 = 0.0;
  double greatest = 0.0;
  std::vector<double> up_to;
  std::vector<std::uint64_t> counts;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "what was measured");
    visit("meaning", self.meaning, "", "from when to when");
    visit("count", self.count, "1", "how often");
    visit("p50", self.p50, "s", "half of all took at most this, to a quarter");
    visit("p99", self.p99, "s", "99 of 100 took at most this, to a quarter");
    visit("greatest", self.greatest, "s", "the longest");
    visit("up_to", self.up_to, "s", "upper bounds of the buckets that are not empty");
    visit("counts", self.counts, "1", "how many fell into each of them");
  }
};

/// How a bench that flew in real time kept its time.
struct BenchTiming {
  std::vector<DurationCounts> stages;
  std::uint64_t passes = 0;
  std::uint64_t missed = 0;
  std::uint64_t most_missed = 0;
  std::uint64_t page_faults = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("stages", self.stages, "", "of the control loop");
    visit("passes", self.passes, "1", "of the control loop");
    visit("missed", self.missed, "1", "control periods in which it did not look");
    visit("most_missed", self.most_missed, "1", "of them the most in a row");
    visit("page_faults", self.page_faults, "1", "in its ticks: times that memory had to be waited for");
  }
};

}  // namespace ironbird::scenarios
