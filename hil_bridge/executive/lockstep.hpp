#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "hil_bridge/executive/control_tick.hpp"

namespace ironbird::hil_bridge {

/// The metronome of simulated runs: one thread, no waiting, as fast as it goes. Nothing here reads a clock:
/// the ticks are the time. docs/conventions.md, tick semantics.
class Lockstep {
 public:
  /// @param period  of a tick, > 0
  Lockstep(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard, Time period);

  /// One tick. @param in_time  whoever lets real time pass has not stood still. @return the time reached
  Time tick(bool in_time = true);

  Time now() const { return now_; }
  /// As ControlTick's.
  void on_step(std::function<void(Time)> told) { tick_.on_step(std::move(told)); }
  const Telemetry& telemetry() const { return tick_.telemetry(); }
  /// The autopilot worked in the last tick.
  bool stepped() const { return tick_.stepped(); }
  /// Texts that the FCU sent in the last tick.
  const std::vector<rosflight::Statustext>& texts() const { return tick_.texts(); }

 private:
  Fcu& fcu_;
  ControlTick tick_;
  Time period_;
  Time now_{0};
  Time next_heartbeat_{0};
};

}  // namespace ironbird::hil_bridge
