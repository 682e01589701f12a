#include "scenarios/requirements/value_assertions.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/requirements/attitude.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

constexpr const char* kThereFromTheStart = "it was there from the start; `after` says from when it counts";

std::string at(double time) {
  return " at " + with_unit(time, "s");
}

}  // namespace

void fill(CheckResult& result, const stl::Robustness& found, const std::string& unit, Angles angles) {
  const bool is_only_a_sign = std::abs(found.margin) <= std::numeric_limits<double>::min();
  result.outcome = found.margin >= 0.0 ? Outcome::kPass : Outcome::kFail;
  result.margin = is_only_a_sign ? 0.0 : found.margin;
  result.unit = unit;
  result.angles = angles;
  result.time = found.time;
}

void fill_unseen(CheckResult& result, const std::string& what) {
  result.outcome = Outcome::kInconclusive;
  result.margin = kNoMargin;
  result.time = kNoMargin;
  result.explanation = what + " was never there to be judged";
}

void ValueAssertion::sample(double time) {
  if (!subject_.present() || broken_at_ || !applies()) return;
  seen_ = true;
  if (!std::isfinite(subject_.magnitude())) {
    broken_at_ = time;
    return;
  }
  take(time);
}

void ValueAssertion::judge(const RunFacts&, CheckResult& result) const {
  if (!seen_) return fill_unseen(result, wording_.what);
  if (!broken_at_) {
    conclude(result);
    return object(result, objection());
  }
  fill(result, {-std::numeric_limits<double>::infinity(), *broken_at_}, wording_);
  result.explanation = wording_.what + " was not a number" + at(*broken_at_);
}

void RmsBelow::take(double time) {
  const double magnitude = subject().magnitude();
  mean_square_.add(magnitude);
  largest_.sample(time, std::abs(magnitude));
}

void RmsBelow::conclude(CheckResult& result) const {
  const stl::Robustness largest = *largest_.robustness();
  fill(result, {bound_ - mean_square_.root(), largest.time}, wording());
  result.explanation = "rms of " + wording().what + " was " + wording().say(mean_square_.root()) +
                       ", must be " + wording().bound + "; largest " + wording().say(largest.margin) +
                       at(largest.time);
}

Stays::Stays(Subject subject, Wording wording, std::optional<double> tolerated_for, double tick)
    : ValueAssertion(std::move(subject), std::move(wording)) {
  if (tolerated_for) recently_.emplace(*tolerated_for, tick);
}

void Stays::take(double time) {
  const Measured measured = measure();
  if (measured.margin < worst_margin_) {
    worst_margin_ = measured.margin;
    worst_value_ = measured.value;
  }
  latest_ = {measured.margin, time};
  if (recently_) latest_.margin = recently_->sample(time, measured.margin);
  if (!recently_ || recently_->full()) always_.sample(time, latest_.margin);
}

void Stays::conclude(CheckResult& result) const {
  fill(result, always_.robustness().value_or(latest_), wording());
  result.explanation =
      wording().what + " came to " + wording().say(worst_value_) + ", must stay " + wording().bound;
}

std::string Stays::objection() const {
  const bool never_judged = recently_ && !always_.robustness();
  return never_judged && worst_margin_ < 0.0 ? "its window was shorter than tolerated_for" : "";
}

Measured StaysBetween::measure() const {
  const double value = subject().magnitude();
  const bool is_band = std::isfinite(low_) && std::isfinite(high_);
  if (subject().is_angle() && is_band) {
    return {(high_ - low_) / 2.0 - std::abs(wrapped(value - (low_ + high_) / 2.0)), value};
  }
  return {std::min(value - low_, high_ - value), value};
}

Measured StaysInTube::measure() const {
  const double distance = to_polyline(subject().vector(), autopilot_.route).norm();
  return {radius_ - distance, distance};
}

void StaysInTube::take(double time) {
  flown_ = flown_ || (autopilot_.flight.companion_flies() && autopilot_.trajectory.valid);
  Stays::take(time);
}

std::string StaysInTube::objection() const {
  return flown_ ? Stays::objection() : "the route was never flown";
}

void FinalBelow::conclude(CheckResult& result) const {
  fill(result, {bound_ - last_.margin, last_.time}, wording());
  result.explanation = wording().what + " ended " + wording().say(last_.margin) + " off" + at(last_.time) +
                       ", must be " + wording().bound;
}

void Settles::take(double time) {
  if (!start_) start_ = settled_at_ = time;
  const double margin = band_ - std::abs(subject().offset_from(target_));
  always_.sample(time, margin);
  if (margin >= 0.0 && outside_) settled_at_ = time;
  outside_ = margin < 0.0;
  was_outside_ = was_outside_ || outside_;
}

void Settles::conclude(CheckResult& result) const {
  if (!always_.robustness()) {
    result.outcome = Outcome::kInconclusive;
    result.margin = result.time = kNoMargin;
    result.unit = wording().unit;
    result.explanation = "the run ended before " + wording().what + " had to be settled";
    return;
  }
  fill(result, *always_.robustness(), wording());
  result.explanation = outside_ ? wording().what + " had not settled at the end"
                                : wording().what + " settled after " + with_unit(settled_at_ - *start_, "s");
  result.explanation += ", must be " + wording().bound;
}

std::string Settles::objection() const {
  return was_outside_ || may_be_there_ ? "" : kThereFromTheStart;
}

void OvershootBelow::take(double time) {
  const double offset = subject().offset_from(target_);
  if (!direction_) {
    direction_ = offset > 0.0 ? -1.0 : 1.0;
    started_off_ = std::abs(offset);
  }
  always_.sample(time, bound_ - *direction_ * offset);
}

void OvershootBelow::conclude(CheckResult& result) const {
  const stl::Robustness found = *always_.robustness();
  fill(result, found, wording());
  const double past = bound_ - found.margin;
  result.explanation = wording().what +
                       (past > 0.0 ? " went " + wording().say(past) + " past its target" + at(found.time)
                                   : std::string(" never passed its target")) +
                       ", must be " + wording().bound;
}

std::string OvershootBelow::objection() const {
  if (started_off_ <= bound_) return "it was there from the start";
  const double nearest = bound_ - always_.robustness()->margin;
  return nearest < -bound_ ? "it came no nearer than " + wording().say(-nearest) : "";
}

void Reaches::take(double time) {
  if (time > by_) return;
  const double margin = tolerance_ - std::abs(subject().offset_from(target_));
  was_outside_ = was_outside_ || margin < 0.0;
  eventually_.sample(time, margin);
  if (margin >= 0.0 && !first_inside_) first_inside_ = time;
}

void Reaches::conclude(CheckResult& result) const {
  if (!eventually_.robustness()) return fill_unseen(result, wording().what);
  const stl::Robustness found = *eventually_.robustness();
  fill(result, found, wording());
  result.explanation =
      wording().what + (first_inside_ ? " was there" + at(*first_inside_) + ", nearest" : " came nearest") +
      at(found.time) + " at " + wording().say(tolerance_ - found.margin) + ", must come " + wording().bound;
}

std::string Reaches::objection() const {
  return was_outside_ || may_be_there_ ? "" : kThereFromTheStart;
}

}  // namespace ironbird::scenarios
