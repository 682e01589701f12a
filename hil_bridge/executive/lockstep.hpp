#pragma once

#include <vector>

#include "autopilot/autopilot.hpp"
#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/translate/sensor_frame_builder.hpp"
#include "hil_bridge/translate/telemetry.hpp"

namespace ironbird::hil_bridge {

/// The metronome of simulated runs: one thread, no waiting, as fast as it goes.
///
/// In each tick the FCU advances, its messages become sensor frames, the autopilot answers each frame with
/// one command, and the command goes back. Nothing here reads a clock: the ticks are the time.
/// docs/conventions.md, tick semantics.
class Lockstep {
 public:
  /// @param period  of a tick, > 0
  Lockstep(Fcu& fcu, autopilot::Autopilot& pilot, Time period);

  /// One tick. @return the time reached
  Time tick();

  Time now() const { return now_; }
  const Telemetry& telemetry() const { return telemetry_; }

  /// The autopilot worked in the last tick.
  bool stepped() const { return stepped_; }

  /// Texts that the FCU sent in the last tick.
  const std::vector<rosflight::Statustext>& texts() const { return texts_; }

 private:
  void dispatch(const Arrival& arrival);

  Fcu& fcu_;
  autopilot::Autopilot& pilot_;
  Time period_;
  Time now_{0};
  Time next_heartbeat_{0};
  SensorFrameBuilder builder_;
  Telemetry telemetry_;
  std::vector<Arrival> inbox_;
  std::vector<rosflight::Statustext> texts_;
  bool stepped_ = false;
};

}  // namespace ironbird::hil_bridge
