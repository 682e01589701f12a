#include "scenarios/requirements/event_assertions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/value_assertions.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void ConditionAssertion::sample(double time) {
  if (!condition_.present() || broken_at_) return;
  const double margin = condition_.margin();
  if (std::isnan(margin)) {
    broken_at_ = time;
    return;
  }
  eventually_.sample(time, margin);
  if (margin > 0.0 && !first_) first_ = time;
}

void ConditionAssertion::judge(const RunFacts&, CheckResult& result) const {
  result.unit = condition_.unit();
  if (broken_at_) {
    fill(result, {-std::numeric_limits<double>::infinity(), *broken_at_}, condition_.unit());
    result.explanation =
        "the signal of " + condition_.text() + " was not a number at " + with_unit(*broken_at_, "s");
    return;
  }
  if (!eventually_.robustness()) return fill_unseen(result, "the signal of " + condition_.text());
  const stl::Robustness found = *eventually_.robustness();
  fill(result, {must_happen_ ? found.margin : stl::negation(found.margin), first_.value_or(found.time)},
       condition_.unit());
  result.explanation =
      condition_.text() + (first_ ? " at " + with_unit(*first_, "s") : std::string(" at no time"));
}

void OrderOfEvents::judge(const RunFacts& facts, CheckResult& result) const {
  result.unit = "s";
  result.margin = std::numeric_limits<double>::infinity();
  double previous = from_.value_or(0.0);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::optional<double> next = facts.timeline.first(names_[i], previous);
    if (!next) {
      const std::optional<double> earlier = facts.timeline.first(names_[i]);
      result.outcome = Outcome::kFail;
      result.margin = earlier ? *earlier - previous : kNone;
      result.time = earlier.value_or(kNone);
      result.explanation = earlier ? names_[i] + " came at " + with_unit(*earlier, "s") + ", before " +
                                         (i == 0 ? std::string("the window") : names_[i - 1])
                                   : names_[i] + " never happened";
      return;
    }
    if (i > 0 && *next - previous < result.margin) {
      result.margin = *next - previous;
      result.time = *next;
    }
    result.explanation += (i == 0 ? "" : ", ") + names_[i] + " at " + with_unit(*next, "s");
    previous = *next;
  }
  if (names_.size() < 2) result.margin = result.time = kNone;
  result.outcome = Outcome::kPass;
}

void MetricBound::judge(const RunFacts& facts, CheckResult& result) const {
  const auto found = std::find_if(facts.metrics.begin(), facts.metrics.end(),
                                  [this](const Metric& metric) { return metric.name == metric_; });
  result.time = result.margin = kNone;
  if (found == facts.metrics.end() || std::isnan(found->value)) {
    result.explanation = metric_ + " was not measured";
    return;
  }
  fill(result, {below_ ? bound_ - found->value : found->value - bound_, kNone}, found->unit);
  result.explanation = metric_ + " was " + with_unit(found->value, found->unit) + ", must be " +
                       (below_ ? "below " : "above ") + with_unit(bound_, found->unit);
}

}  // namespace ironbird::scenarios
