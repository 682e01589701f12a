#include "scenarios/replay/replay.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "autopilot/math/local_map.hpp"
#include "hil_bridge/translate/sensor_frame_builder.hpp"
#include "scenarios/bench/operator.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/record/topics.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

constexpr Time kAfterTakeOff = std::chrono::seconds(3);
constexpr Time kBeforeLanding = std::chrono::seconds(1);
constexpr Time kProgressPeriod = std::chrono::seconds(1);

std::string seconds_text(Time time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", to_seconds(time));
  return text;
}

}  // namespace

Interval usual_window(const RecordedFlight& flight, Time start) {
  const Interval whole{start, flight.end};
  if (flight.airborne.empty()) return whole;
  const Interval inside{std::max(flight.airborne.front().begin, start) + kAfterTakeOff,
                        flight.airborne.back().end - kBeforeLanding};
  return inside.begin < inside.end ? inside : whole;
}

Replay::Replay(const RecordedFlight& flight, const LoadedScenario& loaded, const autopilot::Modules& modules,
               ReplayOptions options)
    : flight_(flight),
      options_(std::move(options)),
      window_(options_.window.value_or(usual_window(flight, options_.start))),
      autopilot_(make_autopilot(loaded, modules)),
      next_progress_(kProgressPeriod) {
  if (!flight.estimates.empty()) comparison_.emplace(flight.estimates.front(), window_);
  if (!options_.log_file.empty()) wire_log(loaded);
}

void Replay::wire_log(const LoadedScenario& loaded) {
  log_ = std::make_unique<FlightLog>(
      options_.log_file,
      McapOptions{.journal = loaded.scenario.record.journal, .compress = loaded.scenario.record.compress},
      loaded, FlightLog::Sources{*autopilot_, telemetry_, nullptr});
  const std::string whose = flight_.estimates.empty() ? "" : flight_.estimates.front().name;
  log_->recorder().metadata("run", {{"flight", flight_.what}, {"recorded", whose}});
}

ReplayResult Replay::run() {
  hil_bridge::SensorFrameBuilder builder;
  for (const hil_bridge::Arrival& arrival : flight_.messages) {
    telemetry_.take(arrival.message);
    if (arrival.when < options_.start) continue;
    const autopilot::SensorFrame* const frame = builder.push(arrival);
    if (frame == nullptr) continue;
    step(*frame, arrival.when);
    if (!goes_on(arrival.when)) break;
  }
  return finish();
}

void Replay::step(const autopilot::SensorFrame& frame, Time now) {
  autopilot_->step(frame);
  watch_health();
  if (log_) {
    log_->step(now);
    write_recorded(frame, now);
  }
  if (comparison_) {
    for (const EstimateDifference& difference : comparison_->observe(autopilot_->signals().estimate)) {
      if (log_) log_->recorder().write_once(kDifferenceTopic, difference, now);
    }
  }
  if (log_) log_->observe(now, true);
}

autopilot::RequestOutcome Replay::request(const autopilot::Request& request, Time now) {
  autopilot::RequestOutcome outcome = autopilot_->request(request);
  if (!log_) return outcome;
  log_->request(request, outcome, now);
  const auto* swap = std::get_if<autopilot::SwapModule>(&request);
  if (swap == nullptr || !outcome.accepted) return outcome;
  autopilot::for_each_slot([&](const auto& slot) {
    if (swap->slot == slot.name) log_->watch(swap->slot, swap->kind, (*autopilot_.*slot.module)());
  });
  return outcome;
}

bool Replay::goes_on(Time now) {
  if (now < next_progress_) return true;
  next_progress_ += kProgressPeriod;
  interrupted_ = options_.on_progress && !options_.on_progress(now);
  return !interrupted_;
}

ReplayResult Replay::finish() {
  if (log_) log_->close();
  ReplayResult result;
  result.window = window_;
  if (comparison_) result.metrics = comparison_->results();
  result.remarks = findings();
  if (ready_) result.ready = to_seconds(*ready_);
  result.lost_at_end = lost_;
  result.interrupted = interrupted_;
  return result;
}

void Replay::write_recorded(const autopilot::SensorFrame& frame, Time now) {
  const autopilot::LocalOrigin& here = autopilot_->signals().estimate.origin;
  Recorder& recorder = log_->recorder();
  for (; next_phase_ < flight_.phases.size() && flight_.phases[next_phase_].stamp <= now; ++next_phase_)
    recorder.write_once(kRecordedPhaseTopic, flight_.phases[next_phase_], now);
  if (frame.gnss && autopilot::is_usable(frame.gnss->fix) && here.known) {
    const autopilot::GnssSample& fix = *frame.gnss;
    const autopilot::Vector3 p_N =
        autopilot::local_from_geodetic({fix.latitude, fix.longitude, fix.altitude}, here);
    recorder.write_once(kRecordedFixTopic, RecordedFix{fix.stamp, p_N, fix.v_NB_N, fix.horizontal_accuracy},
                        now);
  }
  if (flight_.estimates.empty()) return;
  const RecordedEstimate& recorded = flight_.estimates.front();
  if (!origin_written_ && here.known && recorded.origin.known) {
    const autopilot::Vector3 there = seen_from(here, autopilot::Vector3::Zero(), recorded.origin);
    recorder.write_once(kRecordedOriginTopic, RecordedOrigin{there}, now);
    origin_written_ = true;
  }
  for (; next_attitude_ < recorded.attitudes.size() && recorded.attitudes[next_attitude_].stamp <= now;
       ++next_attitude_)
    recorder.write_once(kRecordedAttitudeTopic, recorded.attitudes[next_attitude_], now);
  for (; next_position_ < recorded.positions.size() && recorded.positions[next_position_].stamp <= now;
       ++next_position_) {
    // Before there is an origin to see it from it cannot be shown beside ours.
    if (recorded.origin.known && !here.known) continue;
    RecordedPosition position = recorded.positions[next_position_];
    position.p_NB_N = seen_from(here, position.p_NB_N, recorded.origin);
    recorder.write_once(kRecordedPositionTopic, position, now);
  }
}

void Replay::watch_health() {
  const autopilot::StateEstimate& estimate = autopilot_->signals().estimate;
  if (!ready_ && autopilot::is_usable(estimate.health)) ready_ = estimate.stamp;
  note_doubts(estimate);
  const bool lost = estimate.health == autopilot::Health::kLost;
  if (lost && !lost_) ++losses_;
  lost_ = lost;
}

/// What the filter says of itself, and for how long.
void Replay::note_doubts(const autopilot::StateEstimate& estimate) {
  const Time passed = seen_ ? estimate.stamp - *seen_ : Time::zero();
  seen_ = estimate.stamp;
  if (!autopilot::is_usable(estimate.health)) return;
  if (estimate.health == autopilot::Health::kDegraded) degraded_ += passed;
  if (estimate.position_doubtful) doubtful_ += passed;
  if (!estimate.position_known) unknown_ += passed;
}

std::vector<std::string> Replay::findings() const {
  std::vector<std::string> all = flight_.remarks;
  if (!ready_) {
    all.emplace_back("the estimator never started: it needs rates, forces, field, pressure and fixes");
  } else if (*ready_ > window_.begin) {
    all.push_back("the estimator was ready after " + seconds_text(*ready_) + ", in the window that counts");
  }
  const std::pair<const char*, Time> doubts[] = {{"the estimate was degraded for ", degraded_},
                                                 {"the estimator doubted its position for ", doubtful_},
                                                 {"the estimator did not know its position for ", unknown_}};
  for (const auto& [what, how_long] : doubts) {
    if (how_long > Time::zero()) all.push_back(what + seconds_text(how_long));
  }
  if (losses_ > 0)
    all.push_back("the estimate was lost " + std::to_string(losses_) + (losses_ == 1 ? " time" : " times"));
  return all;
}

}  // namespace ironbird::scenarios
