#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/condition.hpp"
#include "scenarios/requirements/stl.hpp"
#include "scenarios/requirements/subject.hpp"

namespace ironbird::scenarios {

// The assertions about values. Each turns a sample into a margin and leaves the logic to `stl`.

/// The words of a check about one subject.
struct Wording {
  std::string bound;  ///< for example "below 1 m"
  std::string what;   ///< the subject's name
  std::string unit;   ///< of the margin
  Angles angles = Angles::kDegrees;

  std::string say(double value) const { return with_unit(value, unit, angles); }
};

/// Fills a result from a margin: pass when it is not negative.
void fill(CheckResult& result, const stl::Robustness& found, const std::string& unit,
          Angles angles = Angles::kDegrees);
inline void fill(CheckResult& result, const stl::Robustness& found, const Wording& wording) {
  fill(result, found, wording.unit, wording.angles);
}

/// Fills a result for a check that saw no sample.
void fill_unseen(CheckResult& result, const std::string& what);

/// A margin of one sample: how far the value is inside what is allowed, and the value itself.
struct Measured {
  double margin;
  double value;
};

/// An assertion about a quantity: samples where it is absent are skipped, a value that is not a number fails.
/// Without any sample the check is inconclusive.
class ValueAssertion : public Assertion {
 public:
  ValueAssertion(Subject subject, Wording wording)
      : subject_(std::move(subject)), wording_(std::move(wording)) {}
  void sample(double time) final;
  void judge(const RunFacts& facts, CheckResult& result) const final;

 protected:
  /// False while there is nothing to judge the subject by: the sample is skipped.
  virtual bool applies() const { return true; }
  virtual void take(double time) = 0;
  virtual void conclude(CheckResult& result) const = 0;
  /// Why a pass would show nothing, because what is claimed had no occasion; empty when it had.
  virtual std::string objection() const { return ""; }

  const Subject& subject() const { return subject_; }
  const Wording& wording() const { return wording_; }

 private:
  Subject subject_;
  Wording wording_;
  bool seen_ = false;
  std::optional<double> broken_at_;
};

/// rms_below.
class RmsBelow final : public ValueAssertion {
 public:
  RmsBelow(Subject subject, Wording wording, double bound)
      : ValueAssertion(std::move(subject), std::move(wording)), bound_(bound) {}

 protected:
  void take(double time) override;
  void conclude(CheckResult& result) const override;

 private:
  double bound_;
  MeanSquare mean_square_;
  stl::Eventually largest_;
};

/// stays_below, stays_above, stays_within, stays_within_tube: always inside, or never outside for too long.
class Stays : public ValueAssertion {
 public:
  /// @param tolerated_for  s; a shorter violation does not count
  Stays(Subject subject, Wording wording, std::optional<double> tolerated_for, double tick);

 protected:
  /// The margin of the sample seen now.
  virtual Measured measure() const = 0;

  void take(double time) override;
  void conclude(CheckResult& result) const final;
  std::string objection() const override;

 private:
  std::optional<stl::Recently> recently_;
  stl::Always always_;
  stl::Robustness latest_;
  double worst_value_ = 0.0;
  double worst_margin_ = std::numeric_limits<double>::infinity();
};

/// Between two bounds, either of which may be infinite.
class StaysBetween final : public Stays {
 public:
  StaysBetween(Subject subject, Wording wording, std::optional<double> tolerated_for, double tick, double low,
               double high)
      : Stays(std::move(subject), std::move(wording), tolerated_for, tick), low_(low), high_(high) {}

 protected:
  Measured measure() const override;

 private:
  double low_;
  double high_;
};

/// Near the polyline of the waypoints, while there are any. It must have been flown along, or the check shows
/// nothing: a wide tube reaches down to a vehicle on the ground.
class StaysInTube final : public Stays {
 public:
  StaysInTube(Subject subject, Wording wording, std::optional<double> tolerated_for, double tick,
              double radius, const autopilot::Signals& autopilot)
      : Stays(std::move(subject), std::move(wording), tolerated_for, tick),
        radius_(radius),
        autopilot_(autopilot) {}

 protected:
  bool applies() const override { return !autopilot_.route.waypoints.empty(); }
  Measured measure() const override;
  void take(double time) override;
  std::string objection() const override;

 private:
  double radius_;
  const autopilot::Signals& autopilot_;
  bool flown_ = false;
};

/// final_below.
class FinalBelow final : public ValueAssertion {
 public:
  FinalBelow(Subject subject, Wording wording, double bound, Eigen::Vector3d target)
      : ValueAssertion(std::move(subject), std::move(wording)), bound_(bound), target_(std::move(target)) {}

 protected:
  void take(double time) override { last_ = {std::abs(subject().offset_from(target_)), time}; }
  void conclude(CheckResult& result) const override;

 private:
  double bound_;
  Eigen::Vector3d target_;
  stl::Robustness last_;
};

/// settles: always within the band from `time` after the window's opening on. From the start of the run on it
/// must have been outside before.
class Settles final : public ValueAssertion {
 public:
  /// @param may_be_there  when the window opens
  Settles(Subject subject, Wording wording, double band, double time, Eigen::Vector3d target,
          bool may_be_there)
      : ValueAssertion(std::move(subject), std::move(wording)),
        band_(band),
        target_(std::move(target)),
        may_be_there_(may_be_there),
        always_({.from = time}) {}

 protected:
  void take(double time) override;
  void conclude(CheckResult& result) const override;
  std::string objection() const override;

 private:
  double band_;
  Eigen::Vector3d target_;
  bool may_be_there_;
  stl::Always always_;
  std::optional<double> start_;
  double settled_at_ = 0.0;
  bool was_outside_ = false;
  bool outside_ = false;
};

/// overshoot_below: how far a number goes past its target, seen from where it started. It must have started
/// farther off than the bound and come as near: what never approaches its target cannot overshoot it.
class OvershootBelow final : public ValueAssertion {
 public:
  OvershootBelow(Subject subject, Wording wording, double bound, Eigen::Vector3d target)
      : ValueAssertion(std::move(subject), std::move(wording)), bound_(bound), target_(std::move(target)) {}

 protected:
  void take(double time) override;
  void conclude(CheckResult& result) const override;
  std::string objection() const override;

 private:
  double bound_;
  Eigen::Vector3d target_;
  std::optional<double> direction_;
  double started_off_ = 0.0;
  stl::Always always_;
};

/// reaches: once within the tolerance of the target. From the start of the run on it must have been outside
/// before.
class Reaches final : public ValueAssertion {
 public:
  /// @param by  time of the run, s; infinity: any
  /// @param may_be_there  when the window opens
  Reaches(Subject subject, Wording wording, double tolerance, double by, Eigen::Vector3d target,
          bool may_be_there)
      : ValueAssertion(std::move(subject), std::move(wording)),
        tolerance_(tolerance),
        by_(by),
        target_(std::move(target)),
        may_be_there_(may_be_there) {}

 protected:
  void take(double time) override;
  void conclude(CheckResult& result) const override;
  std::string objection() const override;

 private:
  double tolerance_;
  double by_;
  Eigen::Vector3d target_;
  bool may_be_there_;
  bool was_outside_ = false;
  stl::Eventually eventually_;
  std::optional<double> first_inside_;
};

}  // namespace ironbird::scenarios
