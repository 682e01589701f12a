#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/condition.hpp"
#include "scenarios/requirements/stl.hpp"

namespace ironbird::scenarios {

// The assertions about conditions, events and metrics.

/// happens and never_happens. From the start of the run on, what happens must not have been so before.
class ConditionAssertion final : public Assertion {
 public:
  /// @param may_be_so  when the window opens
  ConditionAssertion(Condition condition, bool must_happen, bool may_be_so)
      : condition_(std::move(condition)), must_happen_(must_happen), may_be_so_(may_be_so) {}
  void sample(double time) override;
  void judge(const RunFacts& facts, CheckResult& result) const override;

 private:
  Condition condition_;
  bool must_happen_;
  bool may_be_so_;
  bool was_not_so_ = false;
  stl::Eventually eventually_;
  std::optional<double> first_;
  std::optional<double> broken_at_;
};

/// Looks at events by their names, and knows where its window began and ended.
class EventsInWindow : public Assertion {
 public:
  void sample(double time) override {
    if (!from_) from_ = time;
    until_ = time;
  }

 protected:
  explicit EventsInWindow(std::vector<std::string> names) : names_(std::move(names)) {}

  std::vector<std::string> names_;
  std::optional<double> from_;
  double until_ = 0.0;
};

/// order_of_events: each event once more after the one before, all inside the window; an event serves once.
/// The margin is the least time between two.
class OrderOfEvents final : public EventsInWindow {
 public:
  explicit OrderOfEvents(std::vector<std::string> names) : EventsInWindow(std::move(names)) {}
  void judge(const RunFacts& facts, CheckResult& result) const override;

 private:
  void fail(const Timeline& timeline, std::size_t name, double previous, CheckResult& result) const;
};

/// none_of_events: no event of these names inside the window. It has no margin.
class NoneOfEvents final : public EventsInWindow {
 public:
  explicit NoneOfEvents(std::vector<std::string> names) : EventsInWindow(std::move(names)) {}
  void judge(const RunFacts& facts, CheckResult& result) const override;
};

/// metric_below and metric_above.
class MetricBound final : public Assertion {
 public:
  /// @param bound  as in the scenario file, read in the metric's unit at the end
  MetricBound(std::string metric, double bound, bool below)
      : metric_(std::move(metric)), bound_(bound), below_(below) {}
  void sample(double) override {}
  void judge(const RunFacts& facts, CheckResult& result) const override;

 private:
  std::string metric_;
  double bound_;
  bool below_;
};

}  // namespace ironbird::scenarios
