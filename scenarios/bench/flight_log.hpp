#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/serial_fcu/link_statistics.hpp"
#include "hil_bridge/translate/telemetry.hpp"
#include "scenarios/bench/operator.hpp"
#include "scenarios/bench/probe_recorder.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/record/topics.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {

/// The log of one run, as its scenario wants it.
class FlightLog {
 public:
  using Time = std::chrono::nanoseconds;

  /// What is watched; all outlive the log.
  struct Sources {
    const autopilot::Autopilot& autopilot;
    const hil_bridge::Telemetry& fcu;
    const simulator::Truth* truth;  ///< null on a real vehicle
  };

  /// @param file  how it is laid out
  /// @throws std::runtime_error when the file cannot be made
  FlightLog(const std::filesystem::path& path, const McapOptions& file, const LoadedScenario& loaded,
            const Sources& sources);

  /// How often it is found out how the unit's line does, and written down.
  static constexpr Time kLinkPeriod = std::chrono::milliseconds(100);
  /// Writes that down. @param link  outlives the log
  void add(const hil_bridge::LinkHealth& link) {
    recorder_.add("/fcu/link", link, kLinkPeriod, Recorder::When::kAlways);
  }

  /// Hears from now on of whatever the operator asks, and of the modules that come by it. The log outlives
  /// the last of that.
  void follow(Operator& asks);
  /// To be called after each step of the autopilot: writes down what it was told and what it answered.
  void step(Time now);
  /// To be called whenever something is asked of the autopilot, in the order of that and the steps.
  void request(const autopilot::Request& request, const autopilot::RequestOutcome& outcome, Time now);
  /// To be called after every tick. @param stepped  the autopilot worked in it
  void observe(Time now, bool stepped);
  void event(const RunEvent& event, Time now) { recorder_.write_once(kEventTopic, event, now); }
  /// From now on `module` flies in `slot`.
  void watch(const std::string& slot, const std::string& kind, const autopilot::Module& module) {
    probes_.watch(slot, kind, module);
  }
  Recorder& recorder() { return recorder_; }
  void close() { recorder_.close(); }

 private:
  void add_topics(const LoadedScenario& loaded);

  Sources sources_;
  Recorder recorder_;
  ProbeRecorder probes_;
  Recorder::Channel sensors_;
  Recorder::Channel command_;
  std::uint32_t recorded_route_ = 0;
};

}  // namespace ironbird::scenarios
