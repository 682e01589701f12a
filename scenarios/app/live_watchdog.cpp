#include "scenarios/app/live_watchdog.hpp"

#include <chrono>

#include "scenarios/bench/make_guard.hpp"

namespace ironbird::scenarios {

using hil_bridge::InterlockState;

namespace {

// A terminal that is held for a moment is no reason to end a flight.
constexpr hil_bridge::Time kOperatorLimit = std::chrono::seconds(5);

hil_bridge::WatchdogConfig config_of(const Scenario& scenario) {
  const auto timeout = std::chrono::milliseconds(unit_parameter(scenario, "OFFBOARD_TIMEOUT"));
  hil_bridge::WatchdogConfig config;
  config.profile = scenario.interlock.profile;
  config.threads = {{"the control loop", timeout / 2}, {"the operator's thread", kOperatorLimit}};
  return config;
}

}  // namespace

LiveWatchdog::LiveWatchdog(const Scenario& scenario) : watchdog_(config_of(scenario)) {}

void LiveWatchdog::before_pass(LiveBench& bench, const hil_bridge::transport::ByteStream& line) {
  watchdog_.pulse(kLoop).beat();
  if (line.is_up() && !line_was_up_) watchdog_.guard_line(line.descriptor());
  line_was_up_ = line.is_up();
  const InterlockState state = bench.interlock().state;
  const bool released = state == InterlockState::kReleased || state == InterlockState::kLive;
  // After a kill on the stand zeros leave until the end.
  was_released_ = released || (was_released_ && state == InterlockState::kKilled);
  watchdog_.gate_open(was_released_);
  bench.watchdog(watchdog_.watching(std::chrono::steady_clock::now().time_since_epoch()));
}

std::string LiveWatchdog::note() const {
  return watchdog_.has_priority()
             ? ""
             : "the watchdog runs without real-time priority, which this machine does not "
               "permit: on a busy machine it may be late";
}

void LiveWatchdog::leave() {
  watchdog_.pulse(kOperator).rest();
  watchdog_.gate_open(false);
  watchdog_.leave();
}

}  // namespace ironbird::scenarios
