#include "hil_bridge/serial_fcu/time_sync.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::hil_bridge {

namespace {

using std::chrono::microseconds;

constexpr Time kSlowerThanLeast = microseconds(500);     // of a round trip, still believed
constexpr Time kWrong = std::chrono::milliseconds(10);   // beyond what an exchange leaves possible
constexpr int kProof = 2;                                // such exchanges in a row: one may be forged
constexpr Time kCatchUp = std::chrono::seconds(1);       // in which the line used reaches the fitted one
constexpr Time kShortestSpan = std::chrono::seconds(4);  // of samples that tell a drift,
constexpr double kFewest = 8.0;                          // and how many it takes
constexpr double kGreatestDrift = 5e-4;                  // s/s; crystals are better than 1e-4

double in_seconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

Time from_seconds(double value) {
  return Time(static_cast<std::int64_t>(std::llround(value * 1e9)));
}

}  // namespace

void TimeSync::exchange(Time sent, Time fcu, Time arrived) {
  const Time round_trip = arrived - sent;
  if (round_trip < Time::zero()) return;
  const Sample sample{fcu, sent + round_trip / 2 - fcu, round_trip};
  samples_[next_] = sample;
  next_ = (next_ + 1) % kRemembered;
  count_ = std::min(count_ + 1, kRemembered);
  state_.round_trip = round_trip;
  Time least = round_trip;
  for (std::size_t k = 0; k < count_; ++k) least = std::min(least, samples_[k].round_trip);
  state_.least_round_trip = least;
  if (round_trip > least + kSlowerThanLeast) {
    ++state_.ignored;
    return;
  }
  ++state_.used;
  contradictions_ = state_.valid && contradicts(sample) ? contradictions_ + 1 : 0;
  if (!state_.valid || contradictions_ >= kProof) begin_with(sample);
  fit(fcu);
}

bool TimeSync::contradicts(const Sample& sample) const {
  return std::chrono::abs(present_offset(sample.fcu) - sample.offset) > sample.round_trip / 2 + kWrong;
}

void TimeSync::begin_with(const Sample& sample) {
  samples_[0] = sample;
  count_ = 1;
  next_ = 1;
  anchor_ = sample.fcu;
  anchor_offset_ = sample.offset;
  drift_ = 0.0;
  catch_up_ = 0.0;
  error_ = Time::zero();
  contradictions_ = 0;
  state_.valid = true;
  state_.least_round_trip = sample.round_trip;
}

void TimeSync::fit(Time fcu) {
  const Time reference = fcu;
  double n = 0.0;
  double sum_t = 0.0;
  double sum_o = 0.0;
  double sum_tt = 0.0;
  double sum_to = 0.0;
  double earliest = 0.0;
  for (std::size_t k = 0; k < count_; ++k) {
    if (samples_[k].round_trip > state_.least_round_trip + kSlowerThanLeast) continue;
    const double t = in_seconds(samples_[k].fcu - reference);
    const double offset = in_seconds(samples_[k].offset - anchor_offset_);
    n += 1.0;
    sum_t += t;
    sum_o += offset;
    sum_tt += t * t;
    sum_to += t * offset;
    earliest = std::min(earliest, t);
  }
  const double spread = n * sum_tt - sum_t * sum_t;
  const bool tells_drift = n >= kFewest && -earliest >= in_seconds(kShortestSpan) && spread > 0.0;
  const double drift =
      tells_drift ? std::clamp((n * sum_to - sum_t * sum_o) / spread, -kGreatestDrift, kGreatestDrift) : 0.0;
  const Time fitted = anchor_offset_ + from_seconds((sum_o - drift * sum_t) / n);
  const Time present = present_offset(fcu);
  anchor_ = fcu;
  anchor_offset_ = present;
  drift_ = drift;
  error_ = fitted - present;
  const double fastest = kGreatestSlew - std::abs(drift);
  catch_up_ = std::clamp(in_seconds(error_) / in_seconds(kCatchUp), -fastest, fastest);
  state_.drift = drift;
  state_.offset = present;
}

Time TimeSync::present_offset(Time fcu) const {
  const double passed = in_seconds(fcu - anchor_);
  // What was to be caught up is caught up once: the next exchange that is believed may be long in coming.
  const double caught_up =
      std::min(std::abs(catch_up_) * std::max(passed, 0.0), std::abs(in_seconds(error_)));
  return anchor_offset_ + from_seconds(drift_ * passed + std::copysign(caught_up, catch_up_));
}

Time TimeSync::to_bench(Time fcu, Time fallback) {
  if (!state_.valid) return fallback;
  Time bench = fcu + present_offset(fcu);
  // A stamp from before the last exchange sees the new line's slope; it must not fall behind one given
  // before.
  if (fcu >= latest_fcu_) {
    bench = std::max(bench, latest_bench_);
    latest_fcu_ = fcu;
    latest_bench_ = bench;
  }
  return bench;
}

void TimeSync::reset() {
  *this = TimeSync();
}

}  // namespace ironbird::hil_bridge
