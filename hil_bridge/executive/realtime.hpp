#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "hil_bridge/executive/control_tick.hpp"
#include "hil_bridge/transport/byte_stream.hpp"

namespace ironbird::hil_bridge {

/// How the real-time executive paces itself.
struct RealtimeConfig {
  Time period = std::chrono::microseconds(2500);
  int greatest_missed = 20;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("period", self.period, "ns", "control period: at least so often it looks at everything");
    visit("greatest_missed", self.greatest_missed, "1", "so many periods missed in a row are too many");
  }
};

/// The metronome of real runs: the same tick as in lock-step, as soon as bytes arrive, and when none do, once
/// in every control period, so that what has to end does end.
///
/// One thread does all of it: who wakes for the bytes of an IMU frame also writes the command that answers
/// it. It waits in the clock and nowhere else; a pass takes no memory and no lock, and its only system calls
/// are those of line and clock. docs/decisions/0015-who-waits-for-what.md.
class Realtime {
 public:
  /// All but the configuration outlive this.
  /// @throws std::invalid_argument naming key, value and bound
  Realtime(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard, transport::ByteStream& line, Clock& clock,
           const RealtimeConfig& config);

  /// Waits for bytes or the end of the period, then does one tick. @return its time
  Time pass();

  Time now() const { return now_; }
  /// As ControlTick's.
  void on_step(std::function<void(Time)> told) { tick_.on_step(std::move(told)); }
  const Telemetry& telemetry() const { return tick_.telemetry(); }
  /// The autopilot worked in the last pass.
  bool stepped() const { return tick_.stepped(); }
  const std::vector<rosflight::Statustext>& texts() const { return tick_.texts(); }
  const LoopTiming& timing() const { return tick_.timing(); }
  /// Has it looked often enough lately?
  bool in_time() const { return in_row_ < config_.greatest_missed; }

 private:
  void count_missed(Time now, Time wanted);

  ControlTick tick_;
  transport::ByteStream& line_;
  Clock& clock_;
  RealtimeConfig config_;
  Time now_{};
  int in_row_ = 0;
  bool first_ = true;
};

}  // namespace ironbird::hil_bridge
