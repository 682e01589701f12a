#include "scenarios/requirements/judge.hpp"

#include <stdexcept>
#include <utility>

#include "scenarios/requirements/assertions.hpp"

namespace ironbird::scenarios {

namespace {

CheckResult not_judged_result(const CheckConfig& check, const std::string& reason) {
  CheckResult result;
  result.kind = kind_of(check);
  result.name = check.name.empty() ? result.kind : check.name;
  result.outcome = Outcome::kNotJudged;
  result.margin = result.time = kNoMargin;
  result.explanation = reason;
  return result;
}

}  // namespace

Judge::Judge(const std::vector<CheckConfig>& checks, const SignalTable& signals, RunMetrics::Sources sources,
             Time tick, std::vector<std::string> not_judged)
    : metrics_(sources), detector_(*sources.autopilot) {
  const CheckContext context{&signals, sources.autopilot, autopilot::seconds(tick)};
  checks_.reserve(checks.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    try {
      if (i < not_judged.size() && !not_judged[i].empty()) {
        checks_.emplace_back(not_judged_result(checks[i], not_judged[i]));
      } else {
        checks_.emplace_back(std::in_place_type<Check>, checks[i], context);
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(complaint_at("check[" + std::to_string(i) + "]", error.what()));
    }
  }
}

void Judge::event(Time now, std::string kind, std::string text) {
  timeline_.add(autopilot::seconds(now), std::move(kind), std::move(text));
}

void Judge::observe(Time now) {
  const double time = autopilot::seconds(now);
  detector_.observe(time, timeline_);
  metrics_.observe(now);
  for (auto& each : checks_) {
    if (auto* check = std::get_if<Check>(&each)) check->observe(time, timeline_);
  }
}

Verdict Judge::finish(const RunIdentity& run, const RunFlaws& flaws, double wall_seconds) {
  metrics_.set_wall_time(wall_seconds);
  Verdict verdict;
  verdict.run = run;
  verdict.metrics = metrics_.results();
  const RunFacts facts{timeline_, verdict.metrics};
  for (const auto& each : checks_) {
    const auto* check = std::get_if<Check>(&each);
    verdict.checks.push_back(check != nullptr ? check->result(facts) : std::get<CheckResult>(each));
  }
  verdict.events = timeline_.events();
  conclude(verdict, flaws);
  return verdict;
}

}  // namespace ironbird::scenarios
