#include "scenarios/requirements/judge.hpp"

#include <stdexcept>
#include <utility>

namespace ironbird::scenarios {

namespace {

double seconds_of(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) * 1e-9;
}

}  // namespace

Judge::Judge(const std::vector<CheckConfig>& checks, const SignalTable& signals, RunMetrics::Sources sources,
             Time tick)
    : metrics_(sources), detector_(*sources.autopilot) {
  const CheckContext context{&signals, sources.autopilot, seconds_of(tick)};
  checks_.reserve(checks.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    try {
      checks_.emplace_back(checks[i], context);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(complaint_at("check[" + std::to_string(i) + "]", error.what()));
    }
  }
}

void Judge::event(Time now, std::string kind, std::string text) {
  timeline_.add(seconds_of(now), std::move(kind), std::move(text));
}

void Judge::observe(Time now) {
  const double time = seconds_of(now);
  detector_.observe(time, timeline_);
  metrics_.observe(now);
  for (Check& check : checks_) check.observe(time, timeline_);
}

Verdict Judge::finish(const RunIdentity& run, const RunFlaws& flaws, double wall_seconds) {
  metrics_.set_wall_time(wall_seconds);
  Verdict verdict;
  verdict.run = run;
  verdict.metrics = metrics_.results();
  const RunFacts facts{timeline_, verdict.metrics};
  for (const Check& check : checks_) verdict.checks.push_back(check.result(facts));
  verdict.events = timeline_.events();
  conclude(verdict, flaws);
  return verdict;
}

}  // namespace ironbird::scenarios
