#include "scenarios/bench/bench.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "scenarios/bench/check_rules.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/bench/world_maker.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Vector3;

constexpr std::chrono::nanoseconds kProgressPeriod = std::chrono::seconds(1);

}  // namespace

Bench::Bench(const LoadedScenario& loaded, const autopilot::Modules& modules, BenchOptions options)
    : loaded_(loaded), scenario_(loaded.scenario), options_(std::move(options)) {
  world_ = make_world(scenario_);
  fcu_ = std::make_unique<hil_bridge::VirtualFcu>(scenario_.fcu, *world_);
  wire_autopilot(modules);
  lockstep_ = std::make_unique<hil_bridge::Lockstep>(reached_fcu(), *autopilot_, scenario_.fcu.tick);
  add_signals(signals_, world_->truth(), autopilot_->signals(), lockstep_->telemetry(),
              scenario_.vehicle.rotors.size());
  judge_ = std::make_unique<Judge>(scenario_.checks, signals_,
                                   RunMetrics::Sources{&world_->truth(), &autopilot_->signals()},
                                   scenario_.fcu.tick);
  wire_script();
  if (!options_.log_file.empty()) wire_record();
}

Bench::~Bench() = default;

hil_bridge::Fcu& Bench::reached_fcu() {
  if (scenario_.fcu.kind == hil_bridge::FcuKind::kVirtual) return *fcu_;
  const auto& parameters = fcu_->firmware().parameters();
  const int system = parameters.integer(hil_bridge::virtual_fcu::find_parameter("SYS_ID"));
  line_ = std::make_unique<hil_bridge::VirtualSerialFcu>(*fcu_, static_cast<std::uint8_t>(system), &gate_);
  return *line_;
}

void Bench::wire_autopilot(const autopilot::Modules& modules) {
  autopilot_ = std::make_unique<autopilot::Autopilot>(loaded_.autopilot, modules);
  autopilot::for_each_slot([&](const auto& slot) {
    const ModuleSettings* settings =
        loaded_.settings_of(std::string(slot.name), (loaded_.autopilot.*slot.config).kind);
    if (settings != nullptr) autopilot_->parameters().set_all(settings->values);
  });
  if (!scenario_.waypoints.empty()) {
    ask(autopilot::RouteRequest(autopilot::SetRoute{scenario_.waypoints, scenario_.cyclic}), "route",
        Time{0});
  }
}

void Bench::wire_record() {
  RecorderOptions layout;
  layout.file.journal = scenario_.record.journal;
  layout.file.compress = scenario_.record.compress;
  recorder_ = std::make_unique<Recorder>(options_.log_file, layout);
  recorder_->metadata("run", {{"title", scenario_.title},
                              {"source", scenario_.source},
                              {"scenario", loaded_.name},
                              {"vehicle", scenario_.vehicle_folder},
                              {"field", scenario_.field},
                              {"seed", std::to_string(scenario_.seed)},
                              {"digest", loaded_.digest},
                              {"version", IRONBIRD_VERSION},
                              {"config", loaded_.effective_config}});
  const autopilot::Signals& signals = autopilot_->signals();
  const Time state = from_seconds(scenario_.record.state_period);
  const Time slow = from_seconds(scenario_.record.signal_period);
  recorder_->add("/truth/state", world_->truth(), state, Recorder::When::kAlways);
  recorder_->add("/autopilot/estimate", signals.estimate, state);
  if (scenario_.record.frames) {
    recorder_->add("/autopilot/sensors", signals.sensors);
    recorder_->add("/autopilot/command", signals.command);
  }
  recorder_->add("/autopilot/flight", signals.flight, slow);
  recorder_->add("/autopilot/trajectory", signals.trajectory, slow);
  recorder_->add("/autopilot/setpoint", signals.setpoint, slow);
  const hil_bridge::Telemetry& telemetry = lockstep_->telemetry();
  recorder_->add("/fcu/output_raw", telemetry.output_raw, slow);
  recorder_->add("/fcu/status", telemetry.status, slow);
  recorder_->add("/fcu/attitude", telemetry.attitude, slow);
  recorder_->add("/fcu/battery", telemetry.battery, slow);
  recorder_->add("/fcu/rc", telemetry.rc, slow);
  wire_probes();
}

void Bench::wire_probes() {
  probes_ = std::make_unique<ProbeRecorder>(*recorder_, from_seconds(scenario_.record.signal_period));
  autopilot::for_each_slot([&](const auto& slot) {
    probes_->watch(slot.name, (loaded_.autopilot.*slot.config).kind, (*autopilot_.*slot.module)());
  });
}

void Bench::wire_script() {
  if (scenario_.pilot.automatic) {
    schedule("", scenario_.pilot.arm_at, {Deed::Kind::kArm, 0});
    schedule("", scenario_.pilot.arm_at + PilotConfig::kHandOverDelay, {Deed::Kind::kHandOver, 0});
    schedule("", scenario_.pilot.take_off_at, {Deed::Kind::kTakeOff, 0});
  }
  for (std::size_t i = 0; i < scenario_.events.size(); ++i) {
    schedule(scenario_.events[i].after, scenario_.events[i].at, {Deed::Kind::kEvent, i});
  }
  for (std::size_t i = 0; i < scenario_.snapshots.size(); ++i) {
    schedule(scenario_.snapshots[i].after, scenario_.snapshots[i].at, {Deed::Kind::kSnapshot, i});
  }
  schedule("", scenario_.duration, {Deed::Kind::kEnd, 0});
  if (!scenario_.end_after.empty()) schedule(scenario_.end_after, scenario_.end_delay, {Deed::Kind::kEnd, 0});
}

void Bench::schedule(const std::string& after, double delay, Deed deed) {
  script_.add(after, from_seconds(delay));
  deeds_.push_back(deed);
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
  if (recorder_) recorder_->close();
  return finish(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

Bench::Time Bench::tick() {
  do_what_is_due(lockstep_->now());
  const Time now = lockstep_->tick();
  watch(now);
  judge_->observe(now);
  if (published_events_ != judge_->events().size()) publish_events(now);
  if (recorder_) {
    // The truth goes on when the FCU hears nothing of it.
    if (lockstep_->stepped()) probes_->observe(now);
    recorder_->observe(now, lockstep_->stepped());
    if (autopilot_->signals().route.revision != recorded_route_) record_route(now);
  }
  return now;
}

void Bench::watch(Time now) {
  if (const auto seen = ground_.observe(world_->truth())) judge_->event(now, "ground", std::string(*seen));
  for (const auto& text : lockstep_->texts()) {
    const std::string_view words = hil_bridge::rosflight::text_of(text.text);
    if (texts_.is_news(words, now)) judge_->event(now, "fcu", std::string(words));
  }
  if (const char* failure = world_->failure()) {
    broken_promises_.emplace_back(std::string("the physics engine can no longer be believed: ") + failure);
    ended_ = true;
  }
}

void Bench::publish_events(Time now) {
  const std::vector<RunEvent>& events = judge_->events();
  for (; published_events_ < events.size(); ++published_events_) {
    const RunEvent& event = events[published_events_];
    // A picture's name or a text of the FCU is no event of the flight.
    if (event.kind != "snapshot" && event.kind != "fcu") script_.happened(event.text, now);
    script_.happened(event.kind + ":" + event.text, now);
    const bool is_down = event.kind == "ground" && (event.text == "landed" || event.text == "crashed");
    if (scenario_.pilot.automatic && is_down) {
      schedule("", to_seconds(now) + PilotConfig::kDisarmDelay, {Deed::Kind::kDisarm, 0});
    }
    if (recorder_) recorder_->write_once("/bench/event", event, now);
  }
}

void Bench::record_route(Time now) {
  recorder_->write_once("/autopilot/route", autopilot_->signals().route, now);
  recorded_route_ = autopilot_->signals().route.revision;
}

Verdict Bench::finish(double wall_seconds) {
  if (interrupted_) broken_promises_.emplace_back("the run was interrupted");
  Verdict verdict = judge_->finish({loaded_.name, scenario_.title, scenario_.seed, loaded_.digest},
                                   {broken_promises_, gaps()}, wall_seconds);
  if (!interrupted_) verdict.warnings = warnings();
  return verdict;
}

}  // namespace ironbird::scenarios
