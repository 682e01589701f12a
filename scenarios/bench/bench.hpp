#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/lockstep.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "hil_bridge/serial_fcu/virtual_serial.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/ground_watch.hpp"
#include "scenarios/bench/probe_recorder.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/script.hpp"
#include "scenarios/bench/text_watch.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/requirements/judge.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "scenarios/requirements/verdict.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {

/// How far a run has come.
struct Progress {
  double simulated = 0.0;
  double duration = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("simulated", self.simulated, "s", "flown so far");
    visit("duration", self.duration, "s", "of the run at the most");
  }
};

/// What a run does beside flying.
struct BenchOptions {
  std::filesystem::path log_file;                    ///< empty: no log
  std::function<bool(const Progress&)> on_progress;  ///< called every simulated second; false: stop the run
};

/// Wires one run and flies it: the one place where autopilot, FCU, world, recorder and judge meet.
class Bench {
 public:
  using Time = std::chrono::nanoseconds;

  /// @param loaded  outlives the bench
  /// @throws std::invalid_argument when the scenario cannot be wired, std::runtime_error when the log cannot
  /// be made
  Bench(const LoadedScenario& loaded, const autopilot::Modules& modules, BenchOptions options);
  ~Bench();

  /// Flies to the end and judges. Called once.
  Verdict fly();

  /// One tick, all of it. `fly` calls it. @return the time reached
  Time tick();

  /// The progress callback stopped the run.
  bool interrupted() const { return interrupted_; }

  const simulator::World& world() const { return *world_; }
  const autopilot::Autopilot& autopilot() const { return *autopilot_; }
  const Judge& judge() const { return *judge_; }

 private:
  /// What an item of the script stands for.
  struct Deed {
    enum class Kind { kEvent, kFaultEnd, kArm, kHandOver, kTakeOff, kDisarm, kSnapshot, kEnd };
    Kind kind = Kind::kEvent;
    std::size_t index = 0;  // into the scenario's events or snapshots, or the number of a fault
  };

  /// The unit as the scenario reaches it.
  hil_bridge::Fcu& reached_fcu();
  void wire_autopilot(const autopilot::Modules& modules);
  void wire_record();
  void wire_probes();
  void wire_script();
  void schedule(const std::string& after, double delay, Deed deed);
  void do_what_is_due(Time now);
  void perform(const Deed& deed, Time now);
  void perform(const EventConfig& event, Time now);
  void begin_fault(const EventConfig& event, Time now);
  void perform(PilotAction action);
  void perform(OperatorWish wish, const EventConfig& event, Time now);
  void swap_module(const EventConfig& event, Time now);
  /// @return whether the autopilot accepted it
  bool ask(const autopilot::Request& request, const std::string& what, Time now);
  void watch(Time now);
  void publish_events(Time now);
  void record_route(Time now);
  std::string name_of(const Deed& deed) const;
  std::vector<std::string> gaps() const;
  std::vector<std::string> warnings() const;
  Verdict finish(double wall_seconds);

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  BenchOptions options_;
  std::unique_ptr<simulator::World> world_;
  std::unique_ptr<hil_bridge::VirtualFcu> fcu_;
  hil_bridge::SimulatedUnitGate gate_;
  std::unique_ptr<hil_bridge::VirtualSerialFcu> line_;  // null: called directly
  std::unique_ptr<autopilot::Autopilot> autopilot_;
  std::unique_ptr<hil_bridge::Lockstep> lockstep_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<ProbeRecorder> probes_;
  SignalTable signals_;
  std::unique_ptr<Judge> judge_;
  GroundWatch ground_;
  TextWatch texts_;
  Script script_;
  std::vector<Deed> deeds_;
  std::map<std::size_t, std::string> running_faults_;  // by number
  std::vector<std::string> broken_promises_;
  std::size_t published_events_ = 0;
  std::uint32_t recorded_route_ = 0;
  bool ended_ = false;
  bool interrupted_ = false;
};

}  // namespace ironbird::scenarios
