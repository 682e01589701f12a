#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/lockstep.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/script.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/requirements/check.hpp"
#include "scenarios/requirements/metrics.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "scenarios/requirements/verdict.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {

/// How far a run has come.
struct Progress {
  double simulated = 0.0;  ///< s
  double duration = 0.0;   ///< s, at the most
  std::string phase;
};

/// What a run does beside flying.
struct BenchOptions {
  std::filesystem::path log_file;               ///< empty: no log
  std::function<bool(const Progress&)> progress;  ///< called about every simulated second; false: stop the run
};

/// Wires one run and flies it: the one place where autopilot, FCU, world, recorder and judges meet.
class Bench {
 public:
  /// @throws std::invalid_argument or ConfigError when the scenario cannot be wired
  Bench(const LoadedScenario& loaded, const autopilot::Modules& modules, BenchOptions options);
  ~Bench();

  /// Flies to the end and judges. Called once.
  Verdict fly();

  /// One tick; `fly` calls it. @return the time reached
  std::chrono::nanoseconds tick();

  /// The run was stopped by the progress callback.
  bool interrupted() const { return interrupted_; }

  const simulator::World& world() const { return *world_; }
  const autopilot::Autopilot& autopilot() const { return *autopilot_; }
  const Timeline& timeline() const { return timeline_; }

 private:
  using Time = std::chrono::nanoseconds;

  /// What the script's items stand for.
  struct Deed {
    enum class Kind { kEvent, kFaultEnd, kArm, kTakeOff, kSnapshot, kEnd };
    Kind kind;
    std::size_t index = 0;  // into the scenario's events or snapshots, or a fault's number
  };

  void wire_record();
  void wire_script();
  void add_deed(const std::string& after, double delay, Deed deed);
  void do_what_is_due(Time now);
  void do_deed(const Deed& deed, Time now);
  void do_event(const EventConfig& event, Time now);
  void do_pilot(PilotAction action);
  void do_request(const autopilot::Request& request, const std::string& what, Time now);
  void watch(Time now);
  void tell(Time now, std::string kind, std::string text);
  void publish_events();
  Verdict judge();

  const LoadedScenario& loaded_;
  BenchOptions options_;
  std::unique_ptr<simulator::World> world_;
  std::unique_ptr<hil_bridge::virtual_fcu::VirtualFcu> fcu_;
  std::unique_ptr<autopilot::Autopilot> autopilot_;
  std::unique_ptr<hil_bridge::Lockstep> lockstep_;
  std::unique_ptr<Recorder> recorder_;
  SignalTable signals_;
  std::unique_ptr<CheckList> checks_;
  std::unique_ptr<RunMetrics> metrics_;
  std::unique_ptr<EventDetector> detector_;
  Timeline timeline_;
  Script script_;
  std::vector<Deed> deeds_;
  std::size_t published_ = 0;
  bool ended_ = false;
  bool interrupted_ = false;
};

}  // namespace ironbird::scenarios
