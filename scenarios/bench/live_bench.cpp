#include "scenarios/bench/live_bench.hpp"

#include <limits>
#include <type_traits>
#include <utility>

#include "scenarios/bench/check_rules.hpp"
#include "scenarios/bench/live_rules.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/meeting.hpp"
#include "scenarios/bench/run_time.hpp"

namespace ironbird::scenarios {

using hil_bridge::InterlockState;
using hil_bridge::transport::LinkError;

namespace {

constexpr std::chrono::nanoseconds kLookPeriod = std::chrono::milliseconds(50);
// After a kill the run goes on for the log until the unit is disarmed, or has been silent for so long.
constexpr std::chrono::nanoseconds kGoneForGood = std::chrono::seconds(5);
constexpr std::chrono::nanoseconds kSettled = std::chrono::milliseconds(500);
constexpr std::chrono::nanoseconds kTimingPeriod = std::chrono::seconds(1);

DurationCounts counts_of(const hil_bridge::Histogram& histogram, const char* name, const char* meaning) {
  DurationCounts counts{name,
                        meaning,
                        histogram.count(),
                        to_seconds(histogram.quantile(0.5)),
                        to_seconds(histogram.quantile(0.99)),
                        to_seconds(histogram.greatest()),
                        {},
                        {}};
  for (std::size_t k = 0; k < hil_bridge::Histogram::kBuckets; ++k) {
    if (histogram.counts()[k] == 0) continue;
    const bool bounded = k + 1 < hil_bridge::Histogram::kBuckets;
    counts.up_to.push_back(bounded ? to_seconds(hil_bridge::Histogram::upper_bound(k))
                                   : std::numeric_limits<double>::infinity());
    counts.counts.push_back(histogram.counts()[k]);
  }
  return counts;
}

/// The loop's own measurements, by the names and meanings that it gives them.
BenchTiming timing_of(const hil_bridge::LoopTiming& loop) {
  BenchTiming timing{{}, loop.passes, loop.missed, loop.most_missed, loop.page_faults};
  hil_bridge::LoopTiming::describe(
      loop, [&]<class Value>(const char* name, const Value& value, const char*, const char* meaning) {
        if constexpr (std::is_same_v<Value, hil_bridge::Histogram>) {
          timing.stages.push_back(counts_of(value, name, meaning));
        }
      });
  return timing;
}

}  // namespace

LiveBench::LiveBench(const LoadedScenario& loaded, const autopilot::Modules& modules,
                     const LiveOptions& options, hil_bridge::transport::ByteStream& line,
                     hil_bridge::Clock& clock)
    : loaded_(loaded),
      scenario_(loaded.scenario),
      options_(options),
      line_(line),
      playbook_(scenario_),
      arm_at_(from_seconds(scenario_.pilot.arm_at)) {
  const auto system = static_cast<std::uint8_t>(unit_parameter(scenario_, "SYS_ID"));
  fcu_ = std::make_unique<hil_bridge::SerialFcu>(line, hil_bridge::ConnectionConfig{.system = system});
  unit_watch_ = std::make_unique<hil_bridge::LineUnitWatch>(*fcu_, wanted_parameters(scenario_));
  guard_ = std::make_unique<hil_bridge::Guard>(interlock_config(scenario_), *unit_watch_);
  fcu_->set_gate(*guard_);
  autopilot_ = make_autopilot(loaded_, modules);
  realtime_ = std::make_unique<hil_bridge::Realtime>(
      *fcu_, *autopilot_, *guard_, line, clock,
      hil_bridge::RealtimeConfig{scenario_.fcu.tick, scenario_.interlock.greatest_missed});
  wire_judge();
  operator_ = std::make_unique<Operator>(loaded_, *autopilot_, *judge_);
  playbook_.add_scenario();
  if (!options_.log_file.empty()) wire_log(options_);
}

LiveBench::~LiveBench() {
  close_gate();
}

void LiveBench::wire_judge() {
  add_signals(signals_, nullptr, autopilot_->signals(), realtime_->telemetry(),
              scenario_.vehicle.rotors.size());
  add_link_signals(signals_, scenario_, link_health_, {});
  std::vector<std::string> not_judged;
  for (const CheckConfig& check : scenario_.checks) not_judged.push_back(why_not_judged(check));
  judge_ = std::make_unique<Judge>(scenario_.checks, signals_,
                                   RunMetrics::Sources{nullptr, &autopilot_->signals()}, scenario_.fcu.tick,
                                   std::move(not_judged));
}

void LiveBench::wire_log(const LiveOptions& options) {
  log_ =
      std::make_unique<FlightLog>(options.log_file, McapOptions{.journal = true, .in_background = true},
                                  loaded_, FlightLog::Sources{*autopilot_, realtime_->telemetry(), nullptr});
  log_->add(link_health_);
  log_->recorder().add("/bench/timing", realtime_->timing(), kTimingPeriod, Recorder::When::kAlways);
  realtime_->on_step([this](Time now) { log_->step(now); });
  log_->follow(*operator_);
}

LiveBench::Time LiveBench::pass() {
  const Time now = realtime_->pass();
  watch_interlock(now);
  pass_wishes_on(now);
  if (now >= next_look_) {
    next_look_ = now + kLookPeriod;
    link_health_ = fcu_->health(now);
    if (!live_since_) look_after_meeting(now);
    if (state_ == InterlockState::kLive) ask_for_take_off(now);
    show(now);
  }
  follow_script(now);
  watch(now);
  ended_ = ended_ || stop_ || is_over(now);
  return now;
}

void LiveBench::watch(Time now) {
  for (const auto& text : realtime_->texts()) {
    const std::string_view words = hil_bridge::rosflight::text_of(text.text);
    if (texts_.is_news(words, now)) judge_->event(now, "fcu", std::string(words));
  }
  // Passes for other bytes than an IMU frame's tell nothing new, but silence must not go unseen.
  if (!realtime_->stepped() && now - observed_ < scenario_.fcu.tick) return;
  observed_ = now;
  if (const auto felt = ground_.observe(autopilot_->signals()))
    judge_->event(now, "ground", std::string(*felt));
  judge_->observe(now);
  if (published_events_ != judge_->events().size()) publish_events(now);
  if (log_) log_->observe(now, realtime_->stepped());
}

void LiveBench::watch_interlock(Time now) {
  const hil_bridge::InterlockStatus& status = guard_->status();
  if (status.state == state_) return;
  state_ = status.state;
  state_since_ = now;
  if (state_ == InterlockState::kKilled) {
    judge_->event(now, "killed", std::string(status.why));
  } else {
    judge_->event(now, "interlock", std::string(name_of(state_)) + ": " + std::string(status.why));
  }
  was_verified_ = was_verified_ || state_ == InterlockState::kVerified;
  if (state_ == InterlockState::kLive && !live_since_) live_since_ = now;
  if (state_ == InterlockState::kKilled) {
    killed_since_ = now;
    why_killed_ = status.why;
  }
}

/// A word on the terminal counts once; one given beforehand, when the unit has been in order for a while.
void LiveBench::pass_wishes_on(Time now) {
  const bool settled = state_ == InterlockState::kVerified && now - state_since_ >= kSettled;
  const bool release = release_.exchange(false) || (options_.released && settled);
  guard_->want({.release = release && !live_since_});
}

void LiveBench::look_after_meeting(Time now) {
  const hil_bridge::Connection& connection = fcu_->connection();
  const std::string where = line_.name() + ": ";
  if (connection.state() == hil_bridge::ConnectionState::kRefused)
    throw LinkError(where + connection.refusal());
  met_ = met_ || connection.state() == hil_bridge::ConnectionState::kReady;
  if (!met_ && now > from_seconds(options_.meeting_patience)) {
    throw LinkError(where + why_not_met(*fcu_, now, options_.meeting_patience));
  }
  const hil_bridge::InterlockInputs& in = guard_->inputs();
  if (met_ && in.unit_known && !in.parameters_equal) throw LinkError(where + differences_text());
  const bool waits = options_.verified_patience > 0.0 && !was_verified_;
  if (waits && now > from_seconds(options_.verified_patience)) {
    throw LinkError(where + "the unit is not ready to be flown: " + what_is_missing(in));
  }
}

std::string LiveBench::differences_text() const {
  return text_about(unit_watch_->different(), scenario_.fcu.line);
}

void LiveBench::follow_script(Time now) {
  if (!live_since_) return;
  while (const auto deed = playbook_.next_due(own_time(now))) {
    if (deed->kind == Deed::Kind::kEnd) {
      ended_ = true;
    } else if (deed->kind == Deed::Kind::kEvent && !scenario_.events[deed->index].pilot) {
      operator_->perform(scenario_.events[deed->index], now);
    }
  }
}

/// A request is granted at once or never; this one is repeated until the pilot lets it.
void LiveBench::ask_for_take_off(Time now) {
  if (took_off_ || !scenario_.pilot.automatic) return;
  took_off_ = operator_->ask_until_granted(autopilot::TakeOff{}, "take_off", now);
  waits_for_pilot_ = !took_off_;
}

void LiveBench::publish_events(Time now) {
  const std::vector<RunEvent>& events = judge_->events();
  for (; published_events_ < events.size(); ++published_events_) {
    if (live_since_) playbook_.hear(events[published_events_], own_time(now));
    if (log_) log_->event(events[published_events_], now);
  }
}

void LiveBench::show(Time now) {
  LiveView view;
  view.time = to_seconds(now);
  view.flown = live_since_ ? to_seconds(own_time(now)) : 0.0;
  view.height = -autopilot_->signals().estimate.p_NB_N.z();
  view.state = state_;
  view.inputs = guard_->inputs();
  view.parameters_known = fcu_->connection().parameters().progress().known;
  view.waits_for_pilot = waits_for_pilot_;
  view_.write(view);
}

bool LiveBench::is_over(Time now) const {
  if (!killed_since_) return false;
  const hil_bridge::InterlockInputs& in = guard_->inputs();
  return (in.unit_disarmed && !in.unit_armed) || now - *killed_since_ > kGoneForGood;
}

/// A flight is not given up for its log; that it is incomplete is said.
void LiveBench::close_log(std::vector<std::string>& broken) {
  try {
    log_->close();
  } catch (const std::exception& error) {
    broken.emplace_back(error.what());
  }
  const std::uint64_t lost = log_->recorder().file().lost();
  if (lost > 0)
    broken.push_back("the disk was too slow: " + std::to_string(lost) + " bytes of the log are missing");
}

void LiveBench::close_gate() {
  const Time now = realtime_->now();
  guard_->close(now);
  if (const auto last = guard_->unasked(now)) fcu_->send(*last);  // on the bench: the motors idle at once
}

Verdict LiveBench::finish(double wall_seconds) {
  std::vector<std::string> broken;
  if (log_) close_log(broken);
  if (killed_since_) {
    broken.push_back("the interlock killed the run at " + std::to_string(to_seconds(*killed_since_)) +
                     " s: " + why_killed_);
  } else if (stop_) {
    broken.emplace_back("the run was interrupted");
  } else if (!live_since_) {
    broken.emplace_back("the run never became live");
  }
  Verdict verdict = judge_->finish({loaded_.name, scenario_.title, scenario_.seed, loaded_.digest},
                                   {broken, playbook_.gaps(judge_->events())}, wall_seconds);
  verdict.timing = timing_of(realtime_->timing());
  if (!stop_) verdict.warnings = playbook_.warnings(judge_->events());
  return verdict;
}

}  // namespace ironbird::scenarios
