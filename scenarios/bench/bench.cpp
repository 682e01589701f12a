#include "scenarios/bench/bench.hpp"

#include <utility>

#include "scenarios/bench/check_rules.hpp"
#include "scenarios/bench/make_guard.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/bench/world_maker.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::nanoseconds kProgressPeriod = std::chrono::seconds(1);

}  // namespace

Bench::Bench(const LoadedScenario& loaded, const autopilot::Modules& modules, BenchOptions options)
    : loaded_(loaded), scenario_(loaded.scenario), options_(std::move(options)), playbook_(scenario_) {
  world_ = make_world(scenario_);
  fcu_ = std::make_unique<hil_bridge::VirtualFcu>(scenario_.fcu, *world_);
  autopilot_ = make_autopilot(loaded_, modules);
  wire_unit();
  add_signals(signals_, &world_->truth(), autopilot_->signals(), lockstep_->telemetry(),
              scenario_.vehicle.rotors.size());
  judge_ = std::make_unique<Judge>(scenario_.checks, signals_,
                                   RunMetrics::Sources{&world_->truth(), &autopilot_->signals()},
                                   scenario_.fcu.tick);
  operator_ = std::make_unique<Operator>(loaded_, *autopilot_, *judge_);
  wire_script();
  if (options_.log_file.empty()) return;
  log_ = std::make_unique<FlightLog>(
      options_.log_file,
      McapOptions{.journal = scenario_.record.journal, .compress = scenario_.record.compress}, loaded_,
      FlightLog::Sources{*autopilot_, lockstep_->telemetry(), &world_->truth()});
  operator_->on_swap([this](const std::string& slot, const std::string& kind,
                            const autopilot::Module& module) { log_->watch(slot, kind, module); });
}

Bench::~Bench() = default;

/// The gate is the same as before a real unit. Who releases it is the simulated pilot, just before they arm.
void Bench::wire_unit() {
  const hil_bridge::InterlockConfig config = interlock_config(scenario_);
  hil_bridge::Fcu* reached = fcu_.get();
  if (scenario_.fcu.kind == FcuKind::kVirtual) {
    unit_watch_ = std::make_unique<hil_bridge::OwnUnitWatch>(has_override_switches(scenario_));
    guard_ = std::make_unique<hil_bridge::Guard>(config, *unit_watch_);
  } else {
    line_ = std::make_unique<hil_bridge::VirtualSerialFcu>(
        *fcu_, static_cast<std::uint8_t>(unit_parameter(scenario_, "SYS_ID")));
    unit_watch_ = std::make_unique<hil_bridge::LineUnitWatch>(line_->serial(), wanted_parameters(scenario_));
    guard_ = std::make_unique<hil_bridge::Guard>(config, *unit_watch_);
    line_->set_gate(*guard_);
    reached = line_.get();
  }
  lockstep_ = std::make_unique<hil_bridge::Lockstep>(*reached, *autopilot_, *guard_, scenario_.fcu.tick);
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
  Time next_progress{0};
  while (!ended_) {
    const Time now = tick();
    if (now >= next_progress && options_.on_progress) {
      next_progress += kProgressPeriod;
      if (!options_.on_progress({to_seconds(now), scenario_.duration})) {
        interrupted_ = true;
        break;
      }
    }
  }
  if (log_) log_->close();
  return finish(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

Bench::Time Bench::tick() {
  do_what_is_due(lockstep_->now());
  const Time now = lockstep_->tick();
  watch(now);
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
  if (killed && !killed_) judge_->event(now, "interlock", "killed: " + std::string(guard_->status().why));
  killed_ = killed;
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
  if (interrupted_) broken_promises_.emplace_back("the run was interrupted");
  Verdict verdict = judge_->finish({loaded_.name, scenario_.title, scenario_.seed, loaded_.digest},
                                   {broken_promises_, playbook_.gaps(judge_->events())}, wall_seconds);
  if (!interrupted_) verdict.warnings = playbook_.warnings(judge_->events());
  return verdict;
}

}  // namespace ironbird::scenarios
