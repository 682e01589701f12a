#pragma once

#include <string>

#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// How far a piece of work has come.
struct WorkDone {
  std::string label;  ///< the run, or "film"
  double done = 0.0;  ///< in the unit of `total`
  double total = 0.0;
  std::string detail;  ///< put behind the bar

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("label", self.label, "", "what is being worked on");
    visit("done", self.done, "1", "how much of it is done");
    visit("total", self.total, "1", "how much there is, in the same unit");
    visit("detail", self.detail, "", "more for whoever watches");
  }
};

/// Hears how a run goes on, while it does.
class RunListener {
 public:
  virtual ~RunListener() = default;

  virtual void progress(const WorkDone& work) = 0;

  /// The flight is over; report, pictures and film may still be made.
  virtual void judged(const Verdict& verdict) = 0;

  /// @param line  something worth knowing, without a line end
  virtual void note(const std::string& line) = 0;
};

}  // namespace ironbird::scenarios
