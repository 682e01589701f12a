#include "scenarios/requirements/event_assertions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/value_assertions.hpp"

namespace ironbird::scenarios {

void ConditionAssertion::sample(double time) {
  if (!condition_.present() || broken_at_) return;
  const double margin = condition_.margin();
  if (std::isnan(margin)) {
    broken_at_ = time;
    return;
  }
  eventually_.sample(time, margin);
  was_not_so_ = was_not_so_ || margin <= 0.0;
  if (margin > 0.0 && !first_) first_ = time;
}

void ConditionAssertion::judge(const RunFacts&, CheckResult& result) const {
  result.unit = condition_.unit();
  if (broken_at_) {
    fill(result, {-std::numeric_limits<double>::infinity(), *broken_at_}, condition_.unit(),
         condition_.angles());
    result.explanation =
        "the signal of " + condition_.text() + " was not a number at " + with_unit(*broken_at_, "s");
    return;
  }
  if (!eventually_.robustness()) return fill_unseen(result, "the signal of " + condition_.text());
  const stl::Robustness found = *eventually_.robustness();
  fill(result, {must_happen_ ? found.margin : stl::negation(found.margin), first_.value_or(found.time)},
       condition_.unit(), condition_.angles());
  result.explanation =
      condition_.text() + (first_ ? " at " + with_unit(*first_, "s") : std::string(" at no time"));
  if (must_happen_ && !was_not_so_ && !may_be_so_)
    object(result, "it was so from the start; `after` says from when it counts");
}

void OrderOfEvents::judge(const RunFacts& facts, CheckResult& result) const {
  result.unit = "s";
  result.margin = result.time = kNoMargin;
  if (!from_) {
    result.explanation = "the run ended before " + names_.front() + " could be waited for";
    return;
  }
  double previous = *from_;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::optional<std::size_t> next = facts.timeline.find(names_[i], previous, used);
    if (!next || facts.timeline.events()[*next].time > until_)
      return fail(facts.timeline, i, previous, result);
    const double time = facts.timeline.events()[*next].time;
    if (i > 0 && !(time - previous >= result.margin)) {
      result.margin = time - previous;
      result.time = time;
    }
    result.explanation += (i == 0 ? "" : ", ") + names_[i] + " at " + with_unit(time, "s");
    previous = time;
    used.push_back(*next);
  }
  result.outcome = Outcome::kPass;
}

void OrderOfEvents::fail(const Timeline& timeline, std::size_t name, double previous,
                         CheckResult& result) const {
  result.outcome = Outcome::kFail;
  result.margin = result.time = kNoMargin;
  const std::optional<std::size_t> later = timeline.find(names_[name], previous);
  const std::optional<double> any = later ? timeline.events()[*later].time : timeline.first(names_[name]);
  if (!any) {
    result.explanation = names_[name] + " never happened";
    return;
  }
  result.time = *any;
  result.explanation = names_[name] + " came at " + with_unit(*any, "s");
  if (*any > until_) {
    result.margin = until_ - *any;
    result.explanation += ", after the end of the window at " + with_unit(until_, "s");
  } else if (*any < previous) {
    result.margin = *any - previous;
    result.explanation += ", before " + (name == 0 ? std::string("the window") : names_[name - 1]);
  } else {
    result.explanation += ", but not once more after that";
  }
}

void NoneOfEvents::judge(const RunFacts& facts, CheckResult& result) const {
  result.unit = "s";
  result.margin = result.time = kNoMargin;
  if (!from_) {
    result.explanation = "the run ended before anything could be listened for";
    return;
  }
  result.outcome = Outcome::kPass;
  for (const std::string& name : names_) {
    const std::optional<double> time = facts.timeline.first(name, *from_);
    const bool happened = time && *time <= until_;
    if (happened && !(*time >= result.time)) result.time = *time;
    if (happened) result.outcome = Outcome::kFail;
    result.explanation += (result.explanation.empty() ? "" : ", ") + name +
                          (happened ? " at " + with_unit(*time, "s") : std::string(" at no time"));
  }
}

void MetricBound::judge(const RunFacts& facts, CheckResult& result) const {
  const auto found = std::find_if(facts.metrics.begin(), facts.metrics.end(),
                                  [this](const Metric& metric) { return metric.name == metric_; });
  result.time = result.margin = kNoMargin;
  if (found == facts.metrics.end() || std::isnan(found->value)) {
    result.explanation = metric_ + " was not measured";
    return;
  }
  fill(result, {below_ ? bound_ - found->value : found->value - bound_, kNoMargin}, found->unit);
  result.explanation = metric_ + " was " + with_unit(found->value, found->unit) + ", must be " +
                       (below_ ? "below " : "above ") + with_unit(bound_, found->unit);
  const bool flew = std::none_of(facts.metrics.begin(), facts.metrics.end(), [](const Metric& metric) {
    return metric.name == kFlightTime && metric.value == 0.0;
  });
  if (!flew && metric_ != kSimulatedTime) object(result, "the vehicle never flew");
}

}  // namespace ironbird::scenarios
