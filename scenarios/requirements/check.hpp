#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/signals.hpp"
#include "scenarios/requirements/check_config.hpp"
#include "scenarios/requirements/metrics.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/outcome.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "scenarios/requirements/window.hpp"

namespace ironbird::scenarios {

/// Where there is no margin, or no single time.
inline constexpr double kNoMargin = std::numeric_limits<double>::quiet_NaN();

/// What one check found.
struct CheckResult {
  std::string name;
  std::string kind;
  Outcome outcome = Outcome::kInconclusive;
  double margin = 0.0;
  std::string unit;
  double time = 0.0;
  std::string explanation;
  Angles angles = Angles::kDegrees;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "what was required");
    visit("kind", self.kind, "", "kind of assertion, by its key in the scenario file");
    visit("outcome", self.outcome, "1", "pass, fail, inconclusive or not judged");
    visit("margin", self.margin, "SI", "distance to failing, in `unit`; negative: failed; NaN: none");
    visit("unit", self.unit, "", "unit of the margin");
    visit("time", self.time, "s", "when the margin was least; NaN: no single time");
    visit("explanation", self.explanation, "", "one line");
    visit("angles", self.angles, "1", "what people count the margin in, when its unit is about angles");
  }
};

/// What all checks of a run share.
struct CheckContext {
  const SignalTable* signals = nullptr;           ///< outlives the checks
  const autopilot::Signals* autopilot = nullptr;  ///< for tubes; may be null
  double tick = 0.0025;                           ///< time between two observations, s, > 0
};

/// What the judge knows at the end of a run.
struct RunFacts {
  const Timeline& timeline;
  const std::vector<Metric>& metrics;
};

/// Takes a pass back: what the check was about did not occur, so that it shows nothing.
void object(CheckResult& result, const std::string& reason);

/// The work of one kind of check: sees samples inside the window, then says what it found.
class Assertion {
 public:
  virtual ~Assertion() = default;

  /// One tick inside the window. @param time  s
  virtual void sample(double time) = 0;

  /// Fills outcome, margin, unit, time and explanation.
  virtual void judge(const RunFacts& facts, CheckResult& result) const = 0;
};

/// One requirement, judged while the run goes on.
class Check {
 public:
  /// @throws std::invalid_argument saying what does not fit: no kind or two, an unknown signal, a bound in
  /// the wrong unit. It begins with the key that is wrong, when it is one: see complaint_at()
  Check(const CheckConfig& config, const CheckContext& context);

  /// To be called after every tick, in order of time.
  void observe(double time, const Timeline& timeline) {
    ended_ = time;
    if (!window_.contains(time, timeline)) return;
    opened_ = true;
    assertion_->sample(time);
  }

  CheckResult result(const RunFacts& facts) const;

 private:
  std::string name_;
  std::string kind_;
  Window window_;
  std::unique_ptr<Assertion> assertion_;
  bool opened_ = false;
  double ended_ = 0.0;  // s
};

/// What a check's constructor has to say, with the path of the check in front: `check[1].signal = …` for what
/// begins with a key, else `check[1]: …`.
std::string complaint_at(const std::string& path, const std::string& complaint);

}  // namespace ironbird::scenarios
