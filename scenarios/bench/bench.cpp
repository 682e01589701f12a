#include "scenarios/bench/bench.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scenarios/bench/check_rules.hpp"
#include "scenarios/bench/event_names.hpp"
#include "scenarios/bench/expected_end.hpp"
#include "scenarios/bench/hil_rig.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/bench/world_maker.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::nanoseconds kProgressPeriod = std::chrono::seconds(1);
// So far behind a unit that does not wait is a hiccup; more, and the flight is another one.
constexpr double kGreatestLoss = 1.0;  // s

}  // namespace

Bench::Bench(const LoadedScenario& loaded, const autopilot::Modules& modules, BenchOptions options)
    : loaded_(loaded),
      scenario_(loaded.scenario),
      options_(std::move(options)),
      playbook_(scenario_),
      link_faults_(loaded.scenario.fcu.link_fault),
      bus_faults_(loaded.scenario.fcu.bus_fault) {
  world_ = make_world(scenario_);
  autopilot_ = make_autopilot(loaded_, modules);
  wire_unit();
  add_signals(signals_, &world_->truth(), autopilot_->signals(), lockstep_->telemetry(),
              scenario_.vehicle.rotors.size());
  const bool on_bus = rig_ && rig_->motors() != nullptr;
  add_link_signals(signals_, scenario_, link_health_, on_bus ? rig_->motors()->status() : no_motors_);
  judge_ = std::make_unique<Judge>(scenario_.checks, signals_,
                                   RunMetrics::Sources{&world_->truth(), &autopilot_->signals()},
                                   scenario_.fcu.tick);
  operator_ = std::make_unique<Operator>(loaded_, *autopilot_, *judge_);
  wire_script();
  if (!options_.log_file.empty()) wire_log();
}

Bench::~Bench() {
  close_gate();
}

void Bench::wire_log() {
  log_ = std::make_unique<FlightLog>(
      options_.log_file,
      McapOptions{.journal = scenario_.record.journal, .compress = scenario_.record.compress}, loaded_,
      FlightLog::Sources{*autopilot_, lockstep_->telemetry(), &world_->truth()});
  lockstep_->on_step([this](Time now) { log_->step(now); });
  log_->follow(*operator_);
  // A line that cannot fail has nothing to tell: its log is that of a unit without a line.
  if (rig_ || (line_ && line_->faults() != nullptr)) {
    log_->add(link_health_);
  }
  if (rig_ && rig_->motors() != nullptr) {
    log_->recorder().add("/can/motors", rig_->motors()->status(),
                         from_seconds(scenario_.record.signal_period), Recorder::When::kAlways);
  }
  if (rig_ && rig_->stand() != nullptr) {
    log_->recorder().add("/stand/motors", rig_->stand()->status(),
                         from_seconds(scenario_.record.signal_period), Recorder::When::kAlways);
  }
}

/// The gate is the same as before a real unit. Who releases it is the simulated pilot, just before they arm;
/// with a unit at the other end of a line the operator.
void Bench::wire_unit() {
  hil_bridge::Fcu* reached = nullptr;
  if (scenario_.fcu.kind == FcuKind::kHil) {
    wire_desk();
    reached = &rig_->fcu();
  } else {
    fcu_ = std::make_unique<hil_bridge::VirtualFcu>(scenario_.fcu, *world_);
    reached = fcu_.get();
    if (scenario_.fcu.kind == FcuKind::kVirtual) {
      unit_watch_ = std::make_unique<hil_bridge::OwnUnitWatch>(has_override_switches(scenario_));
    } else {
      wire_line();
      reached = line_.get();
    }
  }
  guard_ = std::make_unique<hil_bridge::Guard>(interlock_config(scenario_), *unit_watch_);
  if (line_) line_->set_gate(*guard_);
  if (rig_) {
    rig_->set_gate(*guard_);
    rig_->open_stand(guard_->status());
  }
  lockstep_ = std::make_unique<hil_bridge::Lockstep>(*reached, *autopilot_, *guard_, scenario_.fcu.tick);
}

void Bench::wire_line() {
  hil_bridge::VirtualSerialConfig config;
  config.system = static_cast<std::uint8_t>(unit_parameter(scenario_, "SYS_ID"));
  config.seed = scenario_.seed;
  if (line_may_fail()) config.faults = scenario_.fcu.link_fault;
  line_ = std::make_unique<hil_bridge::VirtualSerialFcu>(*fcu_, config);
  unit_watch_ = std::make_unique<hil_bridge::LineUnitWatch>(line_->serial(), wanted_parameters(scenario_));
}

void Bench::wire_desk() {
  if (!scenario_.fcu.has_own_unit() && !options_.released) {
    throw std::invalid_argument(
        "fcu.line = \"" + scenario_.fcu.line +
        "\": the outputs of a unit at the other end of a line may have real motors; say "
        "--release once it is safe");
  }
  rig_ = make_hil_rig(scenario_, *world_, line_may_fail());
  unit_watch_ = std::make_unique<hil_bridge::LineUnitWatch>(rig_->serial(), wanted_parameters(scenario_));
}

bool Bench::line_may_fail() const {
  const auto by_event = [](const EventConfig& event) { return event.link || event.bus; };
  return std::any_of(scenario_.events.begin(), scenario_.events.end(), by_event) ||
         loaded_.gives("fcu.link_fault") || loaded_.gives("fcu.bus_fault");
}

hil_bridge::transport::LinkFault& Bench::line_faults() {
  return rig_ ? *rig_->line_faults() : *line_->faults();
}

hil_bridge::RcPilot* Bench::pilot() {
  return rig_ ? rig_->pilot() : &fcu_->pilot();
}

void Bench::wire_script() {
  if (scenario_.pilot.automatic) {
    playbook_.add("", scenario_.pilot.arm_at, {Deed::Kind::kArm, 0});
    playbook_.add("", scenario_.pilot.arm_at + PilotConfig::kHandOverDelay, {Deed::Kind::kHandOver, 0});
    playbook_.add("", scenario_.pilot.take_off_at, {Deed::Kind::kTakeOff, 0});
  }
  playbook_.add_scenario();
}

Verdict Bench::fly() {
  const auto start = std::chrono::steady_clock::now();
  const double expected = expected_end(loaded_);
  Time next_progress{0};
  while (!ended_) {
    if (options_.stop_wanted && options_.stop_wanted()) {
      interrupted_ = true;
      break;
    }
    const Time now = tick();
    if (now >= next_progress && options_.on_progress) {
      next_progress += kProgressPeriod;
      const double flown = to_seconds(now);
      if (!options_.on_progress({flown, shown_end(expected, flown, scenario_.duration)})) {
        interrupted_ = true;
        break;
      }
    }
  }
  close_gate();
  if (log_) log_->close();
  return finish(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

Bench::Time Bench::tick() {
  do_what_is_due(lockstep_->now());
  const bool in_time = !rig_ || rig_->wait_for(lockstep_->now() + scenario_.fcu.tick);
  const Time now = lockstep_->tick(in_time);
  if (rig_ && rig_->stand() != nullptr) rig_->stand()->step(now);
  if (!in_time)
    broken_promises_.emplace_back("the bench stood still for longer than half a second of the run");
  watch(now);
  watch_link(now);
  judge_->observe(now);
  if (published_events_ != judge_->events().size()) publish_events(now);
  if (log_) log_->observe(now, lockstep_->stepped());
  return now;
}

void Bench::watch(Time now) {
  if (const auto seen = ground_.observe(world_->truth())) judge_->event(now, "ground", std::string(*seen));
  for (const auto& text : lockstep_->texts()) {
    const std::string_view words = hil_bridge::rosflight::text_of(text.text);
    if (texts_.is_news(words, now)) judge_->event(now, "fcu", std::string(words));
  }
  watch_interlock(now);
  if (const char* failure = world_->failure()) {
    broken_promises_.emplace_back(std::string("the physics engine can no longer be believed: ") + failure);
    ended_ = true;
  }
}

/// The way up to live is no news in a simulation; a kill is.
void Bench::watch_interlock(Time now) {
  const bool killed = guard_->status().state == hil_bridge::InterlockState::kKilled;
  if (killed && !killed_) judge_->event(now, "killed", std::string(guard_->status().why));
  killed_ = killed;
  // An operator's word counts once; the simulated pilot's stands until they disarm.
  if (pilot() == nullptr && guard_->status().state == hil_bridge::InterlockState::kLive) guard_->want({});
}

void Bench::watch_link(Time now) {
  if (rig_ && rig_->motors() != nullptr) {
    while (const auto event = rig_->motors()->take_event()) {
      judge_->event(now, "can", std::string(hil_bridge::transport::name_of(event->kind)));
    }
  }
  if (rig_ && rig_->stand() != nullptr) watch_stand(now);
  if ((!rig_ && !line_) || now < next_health_) return;
  next_health_ = now + FlightLog::kLinkPeriod;
  link_health_ = (rig_ ? rig_->serial() : line_->serial()).health(now);
}

void Bench::watch_stand(Time now) {
  while (const auto event = rig_->stand()->take_event()) {
    judge_->event(now, "stand", std::string(hil_bridge::transport::name_of(event->kind)));
  }
  const auto& motors = rig_->stand()->status().motors;
  for (std::size_t motor = 0; motor < scenario_.vehicle.rotors.size(); ++motor) {
    if (motors[motor].ready == stand_ready_[motor]) continue;
    stand_ready_[motor] = motors[motor].ready;
    judge_->event(now, "stand", stand_event(motor, motors[motor].ready));
  }
}

/// Before the paper work, and whatever ended the run: the motors of a stand get their zeros now.
void Bench::close_gate() {
  if (std::exchange(closed_, true)) return;
  guard_->close(lockstep_->now());
  if (rig_ && rig_->stand() != nullptr) rig_->stand()->step(lockstep_->now());
}

void Bench::publish_events(Time now) {
  const std::vector<RunEvent>& events = judge_->events();
  for (; published_events_ < events.size(); ++published_events_) {
    const RunEvent& event = events[published_events_];
    playbook_.hear(event, now);
    const bool is_down = event.kind == "ground" && (event.text == "landed" || event.text == "crashed");
    if (scenario_.pilot.automatic && is_down) {
      playbook_.add_at(now + from_seconds(PilotConfig::kDisarmDelay), {Deed::Kind::kDisarm, 0});
    }
    if (log_) log_->event(event, now);
  }
}

Verdict Bench::finish(double wall_seconds) {
  const double lost = rig_ ? to_seconds(rig_->lost()) * scenario_.fcu.time_scale : 0.0;
  if (lost > kGreatestLoss) {
    broken_promises_.push_back("this machine was too slow: the run fell " + with_unit(lost, "s") +
                               " behind the unit");
  }
  if (interrupted_) broken_promises_.emplace_back("the run was interrupted");
  Verdict verdict = judge_->finish({loaded_.name, scenario_.title, scenario_.seed, loaded_.digest},
                                   {broken_promises_, playbook_.gaps(judge_->events())}, wall_seconds);
  if (!interrupted_) verdict.warnings = playbook_.warnings(judge_->events());
  return verdict;
}

}  // namespace ironbird::scenarios
