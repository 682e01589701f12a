#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/guard.hpp"
#include "hil_bridge/executive/lockstep.hpp"
#include "hil_bridge/hil_fcu/can_motors.hpp"
#include "hil_bridge/serial_fcu/virtual_serial.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "scenarios/bench/flight_log.hpp"
#include "scenarios/bench/ground_watch.hpp"
#include "scenarios/bench/operator.hpp"
#include "scenarios/bench/playbook.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/text_watch.hpp"
#include "scenarios/requirements/judge.hpp"
#include "scenarios/requirements/signal_table.hpp"
#include "scenarios/requirements/verdict.hpp"
#include "simulator/world.hpp"

namespace ironbird::scenarios {

class HilRig;

/// How far a run has come.
struct Progress {
  double simulated = 0.0;
  double expected_end = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("simulated", self.simulated, "s", "flown so far");
    visit("expected_end", self.expected_end, "s", "when the run is likely to end");
  }
};

/// What a run does beside flying.
struct BenchOptions {
  std::filesystem::path log_file;                    ///< empty: no log
  std::function<bool(const Progress&)> on_progress;  ///< called every simulated second; false: stop the run
  std::function<bool()> stop_wanted;                 ///< asked in every tick, when there is one
  bool released = false;  ///< the operator has said so, of a unit at the other end of a line
};

/// Wires one simulated run and flies it: here autopilot, FCU, world, log and judge meet. A run on a real unit
/// is wired by LiveBench.
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
  void wire_unit();
  void wire_line();
  void wire_desk();
  void wire_log();
  /// The line can be made to fail.
  bool line_may_fail() const;
  hil_bridge::transport::LinkFault& line_faults();
  /// Null: one of flesh and blood.
  hil_bridge::RcPilot* pilot();
  void ask_for_take_off(Time now);
  void wire_script();
  void do_what_is_due(Time now);
  void perform(const Deed& deed, Time now);
  void perform(const EventConfig& event, Time now);
  void begin_fault(const EventConfig& event, Time now);
  void begin_link_fault(const EventConfig& event, Time now);
  void end_link_fault(std::size_t number, Time now);
  void release_gate();
  void perform(PilotAction action);
  void watch(Time now);
  void watch_interlock(Time now);
  void watch_link(Time now);
  void watch_stand(Time now);
  void close_gate();
  void publish_events(Time now);
  Verdict finish(double wall_seconds);

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  BenchOptions options_;
  std::unique_ptr<simulator::World> world_;
  std::unique_ptr<hil_bridge::VirtualFcu> fcu_;  // null: the rig has the unit
  std::unique_ptr<HilRig> rig_;                  // null: no hardware in the loop
  std::unique_ptr<hil_bridge::UnitWatch> unit_watch_;
  std::unique_ptr<hil_bridge::Guard> guard_;
  std::unique_ptr<hil_bridge::VirtualSerialFcu> line_;  // null: called directly
  std::unique_ptr<autopilot::Autopilot> autopilot_;
  std::unique_ptr<hil_bridge::Lockstep> lockstep_;
  SignalTable signals_;
  std::unique_ptr<Judge> judge_;
  std::unique_ptr<Operator> operator_;
  std::unique_ptr<FlightLog> log_;  // null: none is wanted
  GroundWatch ground_;
  TextWatch texts_;
  Playbook playbook_;
  std::map<std::size_t, std::string> running_faults_;  // by number
  RunningLinkFaults link_faults_;
  RunningLinkFaults bus_faults_;
  hil_bridge::LinkHealth link_health_;
  hil_bridge::CanMotorsStatus no_motors_;
  std::array<bool, simulator::kMaxRotors> stand_ready_{};
  Time next_health_{};
  std::vector<std::string> broken_promises_;
  std::size_t published_events_ = 0;
  bool killed_ = false;
  bool closed_ = false;
  bool ended_ = false;
  bool interrupted_ = false;
};

}  // namespace ironbird::scenarios
