#include "scenarios/requirements/stl.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace ironbird::scenarios::stl {

namespace {

/// Times are multiples of a period turned into seconds: ends of intervals are met to within this, s.
constexpr double kTimeRoundOff = 1e-9;

bool within(double elapsed, Interval interval) {
  return elapsed >= interval.from - kTimeRoundOff && elapsed <= interval.to + kTimeRoundOff;
}

}  // namespace

void Always::sample(double time, double margin) {
  if (!start_) start_ = time;
  if (!within(time - *start_, interval_)) return;
  if (!worst_ || margin < worst_->margin) worst_ = Robustness{margin, time};
}

void Eventually::sample(double time, double margin) {
  if (!start_) start_ = time;
  if (!within(time - *start_, interval_)) return;
  if (!best_ || margin > best_->margin) best_ = Robustness{margin, time};
}

Recently::Recently(double span, double period) : span_(span) {
  if (!(span >= 0.0) || !(period > 0.0) || span / period > 1e7) {
    throw std::invalid_argument("window of " + std::to_string(span) + " s sampled every " +
                                std::to_string(period) + " s, must hold between 1 and 1e7 samples");
  }
  ring_.resize(static_cast<std::size_t>(std::ceil(span / period)) + 2);
}

double Recently::sample(double time, double margin) {
  if (!start_) start_ = time;
  full_ = time - *start_ >= span_ - kTimeRoundOff;
  while (count_ > 0 && ring_[first_].time < time - span_ - kTimeRoundOff) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }
  while (count_ > 0 && ring_[(first_ + count_ - 1) % ring_.size()].margin <= margin) --count_;
  if (count_ == ring_.size()) {  // samples closer than the period: the oldest gives way
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }
  ring_[(first_ + count_) % ring_.size()] = {time, margin};
  ++count_;
  return ring_[first_].margin;
}

}  // namespace ironbird::scenarios::stl
