#pragma once

#include <string>

#include "hil_bridge/interlock/watchdog/watchdog.hpp"
#include "hil_bridge/transport/byte_stream.hpp"
#include "scenarios/bench/live_bench.hpp"

namespace ironbird::scenarios {

/// The watchdog of a run on a real unit: guards the control loop, for half of the unit's time-out, and the
/// operator's thread, without which Ctrl-C would not be heard. The log's writer is not guarded: when it is
/// stuck the log ends, and nothing else.
///
/// `before_pass` and `loop_ends` belong to the control loop's thread, the rest to the operator's.
class LiveWatchdog {
 public:
  /// Make it before the first thread. @throws std::runtime_error when it cannot be started
  explicit LiveWatchdog(const Scenario& scenario);

  /// Beats, hands over the line when it has come up, and tells the bench how the watchdog is.
  void before_pass(LiveBench& bench, const hil_bridge::transport::ByteStream& line);
  void loop_ends() { watchdog_.pulse(kLoop).rest(); }

  void operator_lives() { watchdog_.pulse(kOperator).beat(); }
  /// What the machine did not grant it, or empty.
  std::string note() const;
  /// The run is over and its gate closed.
  void leave();

 private:
  static constexpr std::size_t kLoop = 0;
  static constexpr std::size_t kOperator = 1;

  hil_bridge::Watchdog watchdog_;
  bool line_was_up_ = false;
  bool was_released_ = false;
};

}  // namespace ironbird::scenarios
