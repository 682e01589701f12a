#include "scenarios/bench/flight_log.hpp"

#include "scenarios/bench/logged_request.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/record/topics.hpp"

namespace ironbird::scenarios {

namespace {

RecorderOptions layout_of(const McapOptions& file) {
  RecorderOptions layout;
  layout.file = file;
  return layout;
}

}  // namespace

FlightLog::FlightLog(const std::filesystem::path& path, const McapOptions& file, const LoadedScenario& loaded,
                     const Sources& sources)
    : sources_(sources),
      recorder_(path, layout_of(file)),
      probes_(recorder_, from_seconds(loaded.scenario.record.signal_period)) {
  const Scenario& scenario = loaded.scenario;
  recorder_.metadata("run", {{"title", scenario.title},
                             {"source", scenario.source},
                             {"scenario", loaded.name},
                             {"vehicle", scenario.vehicle_folder},
                             {"field", scenario.field},
                             {"seed", std::to_string(scenario.seed)},
                             {"digest", loaded.digest},
                             {"version", IRONBIRD_VERSION},
                             {"config", loaded.effective_config}});
  add_topics(loaded);
}

void FlightLog::add_topics(const LoadedScenario& loaded) {
  const RecordConfig& record = loaded.scenario.record;
  const autopilot::Signals& signals = sources_.autopilot.signals();
  const hil_bridge::Telemetry& fcu = sources_.fcu;
  const Time state = from_seconds(record.state_period);
  const Time slow = from_seconds(record.signal_period);
  if (sources_.truth != nullptr) recorder_.add(kTruthTopic, *sources_.truth, state, Recorder::When::kAlways);
  recorder_.add(kEstimateTopic, signals.estimate, state);
  if (record.frames) {
    sensors_ = recorder_.add(kSensorsTopic, signals.sensors, {}, Recorder::When::kWhenTold);
    command_ = recorder_.add(kCommandTopic, signals.command, {}, Recorder::When::kWhenTold);
  }
  recorder_.announce<LoggedRequest>(kRequestTopic);
  recorder_.add(kFlightTopic, signals.flight, slow);
  recorder_.add(kTrajectoryTopic, signals.trajectory, slow);
  recorder_.add(kSetpointTopic, signals.setpoint, slow);
  recorder_.add(kOutputTopic, fcu.output_raw, slow);
  recorder_.add(kStatusTopic, fcu.status, slow);
  recorder_.add(kUnitAttitudeTopic, fcu.attitude, slow);
  recorder_.add(kBatteryTopic, fcu.battery, slow);
  recorder_.add(kRcTopic, fcu.rc, slow);
  autopilot::for_each_slot([&](const auto& slot) {
    probes_.watch(slot.name, (loaded.autopilot.*slot.config).kind, (sources_.autopilot.*slot.module)());
  });
}

void FlightLog::follow(Operator& asks) {
  asks.on_request([this](const autopilot::Request& asked, const autopilot::RequestOutcome& outcome,
                         Time now) { request(asked, outcome, now); });
  asks.on_swap([this](const std::string& slot, const std::string& kind, const autopilot::Module& module) {
    watch(slot, kind, module);
  });
}

void FlightLog::step(Time now) {
  recorder_.write(sensors_, now);
  recorder_.write(command_, now);
}

void FlightLog::request(const autopilot::Request& request, const autopilot::RequestOutcome& outcome,
                        Time now) {
  recorder_.write_once(kRequestTopic, logged(request, outcome), now);
}

void FlightLog::observe(Time now, bool stepped) {
  // The truth goes on when the FCU hears nothing of it.
  if (stepped) probes_.observe(now);
  recorder_.observe(now, stepped);
  const autopilot::Route& route = sources_.autopilot.signals().route;
  if (route.revision == recorded_route_) return;
  recorder_.write_once(kRouteTopic, route, now);
  recorded_route_ = route.revision;
}

}  // namespace ironbird::scenarios
