#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/latest_value.hpp"
#include "hil_bridge/executive/realtime.hpp"
#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "scenarios/bench/felt_ground.hpp"
#include "scenarios/bench/flight_log.hpp"
#include "scenarios/bench/operator.hpp"
#include "scenarios/bench/playbook.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/bench/text_watch.hpp"
#include "scenarios/requirements/judge.hpp"
#include "scenarios/requirements/signal_table.hpp"

namespace ironbird::scenarios {

/// What a run on a real unit does beside flying.
struct LiveOptions {
  std::filesystem::path log_file;  ///< empty: no log
  bool released = false;           ///< the operator has said so beforehand
  double meeting_patience = 5.0;   ///< s, until the unit has said who it is
  double verified_patience = 0.0;  ///< s, until all is as the scenario wants it; 0: for ever
};

/// What the operator sees.
struct LiveView {
  double time = 0.0;
  double flown = 0.0;
  double height = 0.0;
  hil_bridge::InterlockState state = hil_bridge::InterlockState::kCold;
  hil_bridge::InterlockInputs inputs;
  int parameters_known = 0;
  bool waits_for_pilot = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("time", self.time, "s", "since the run began");
    visit("flown", self.flown, "s", "of the scenario's own time, which begins when the pilot arms");
    visit("height", self.height, "m", "above the local origin, as estimated");
    visit("state", self.state, "1", "of the interlock");
    visit("inputs", self.inputs, "", "what the interlock looked at last");
    visit("parameters_known", self.parameters_known, "1", "of the unit's");
    visit("waits_for_pilot", self.waits_for_pilot, "1", "armed, but the autopilot may not take off yet");
  }
};

/// Wires a run on a unit at the other end of a line, and flies it in real time. What flies is what flies in
/// Bench; there is no world, no truth, and a pilot of flesh and blood.
///
/// `pass` belongs to the thread of the control loop; `stop`, `release` and `view` to another one.
///
/// The scenario's own time (its events' times, its duration) begins when the gate goes live, at the
/// scenario's `pilot.arm_at`, as in the simulated flight.
class LiveBench {
 public:
  using Time = std::chrono::nanoseconds;

  /// @param loaded, line, clock  outlive the bench
  /// @throws std::invalid_argument when the scenario cannot be wired, std::runtime_error when the log cannot
  /// be made
  LiveBench(const LoadedScenario& loaded, const autopilot::Modules& modules, const LiveOptions& options,
            hil_bridge::transport::ByteStream& line, hil_bridge::Clock& clock);
  /// Closes the gate first.
  ~LiveBench();

  /// Waits, looks, answers; then watches, judges and writes down. @return the time
  /// @throws transport::LinkError, before anything is released only: not the unit that the scenario wants
  Time pass();
  bool ended() const { return ended_; }
  /// How the watchdog is, before a pass.
  void watchdog(bool awake) { guard_->watchdog(awake); }
  /// Closes the gate. What is left of the run is paper work.
  void close_gate();

  void stop() { stop_ = true; }
  void release() { release_ = true; }
  const LiveView& view() { return view_.read(); }

  /// To be called once, after the last pass.
  Verdict finish(double wall_seconds);

  const hil_bridge::LoopTiming& timing() const { return realtime_->timing(); }
  const hil_bridge::InterlockStatus& interlock() const { return guard_->status(); }
  /// How much has happened so far.
  std::size_t event_count() const { return judge_->events().size(); }

 private:
  void wire_judge();
  void wire_log(const LiveOptions& options);
  void look_after_meeting(Time now);
  void watch(Time now);
  void watch_interlock(Time now);
  void pass_wishes_on(Time now);
  void follow_script(Time now);
  void ask_for_take_off(Time now);
  void publish_events(Time now);
  void show(Time now);
  void close_log(std::vector<std::string>& broken);
  bool is_over(Time now) const;
  /// The scenario's own time, once it runs.
  Time own_time(Time now) const { return now - *live_since_ + arm_at_; }
  std::string differences_text() const;

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  LiveOptions options_;
  hil_bridge::transport::ByteStream& line_;
  std::unique_ptr<hil_bridge::SerialFcu> fcu_;
  std::unique_ptr<hil_bridge::LineUnitWatch> unit_watch_;
  std::unique_ptr<hil_bridge::Guard> guard_;
  std::unique_ptr<autopilot::Autopilot> autopilot_;
  std::unique_ptr<hil_bridge::Realtime> realtime_;
  hil_bridge::LinkHealth link_health_;
  SignalTable signals_;
  std::unique_ptr<Judge> judge_;
  std::unique_ptr<Operator> operator_;
  std::unique_ptr<FlightLog> log_;  // null: none is wanted
  FeltGround ground_;
  TextWatch texts_;
  Playbook playbook_;
  std::size_t published_events_ = 0;
  hil_bridge::InterlockState state_ = hil_bridge::InterlockState::kCold;
  Time arm_at_{};
  std::optional<Time> live_since_;
  std::optional<Time> killed_since_;
  std::string why_killed_;
  Time observed_{-1};
  Time next_look_{};
  bool took_off_ = false;
  bool waits_for_pilot_ = false;
  bool ended_ = false;
  bool met_ = false;
  bool was_verified_ = false;
  Time state_since_{};
  hil_bridge::LatestValue<LiveView> view_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> release_ = false;
};

}  // namespace ironbird::scenarios
