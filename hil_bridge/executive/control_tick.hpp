#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/executive/clock.hpp"
#include "hil_bridge/executive/guard.hpp"
#include "hil_bridge/executive/loop_timing.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/translate/sensor_frame_builder.hpp"
#include "hil_bridge/translate/telemetry.hpp"

namespace ironbird::hil_bridge {

/// One control period, whoever lets the time pass: the FCU advances, its messages become sensor frames, the
/// guard looks at everything, the autopilot answers each frame, and what the guard lets through goes back.
class ControlTick {
 public:
  /// @param fcu, pilot, guard  outlive this
  ControlTick(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard);

  /// Measures from now on. @param clock  outlives this
  void measure(Clock& clock) { clock_ = &clock; }

  /// Told after each step of the autopilot, of which a tick has several when frames waited: its command has
  /// left, its signals are still there.
  void on_step(std::function<void(Time)> told) { on_step_ = std::move(told); }

  /// @param bench_in_time  the loop around it keeps its period
  void run(Time now, bool bench_in_time = true);

  const Telemetry& telemetry() const { return telemetry_; }
  /// The autopilot worked in the last tick.
  bool stepped() const { return stepped_; }
  /// A motor command left in the last tick.
  bool sent() const { return sent_; }
  /// Texts that the FCU sent in the last tick.
  const std::vector<rosflight::Statustext>& texts() const { return texts_; }
  const LoopTiming& timing() const { return timing_; }
  LoopTiming& timing() { return timing_; }

 private:
  void tick(Time now, bool bench_in_time);
  void take(const Arrival& arrival);
  void answer(const Arrival& arrival, Time now);
  void send_if_any(const std::optional<rosflight::OffboardControl>& control);
  /// The time for a measurement; 0 where nobody measures.
  Time mark() { return clock_ == nullptr ? Time{} : clock_->now(); }

  Fcu& fcu_;
  autopilot::Autopilot& pilot_;
  Guard& guard_;
  Clock* clock_ = nullptr;
  std::function<void(Time)> on_step_;  // empty: nobody
  SensorFrameBuilder builder_;
  Telemetry telemetry_;
  LoopTiming timing_;
  std::vector<Arrival> inbox_;
  std::vector<rosflight::Statustext> texts_;
  Time woke_{};
  bool stepped_ = false;
  bool sent_ = false;
};

}  // namespace ironbird::hil_bridge
