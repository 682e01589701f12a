#include "hil_bridge/executive/lockstep.hpp"

#include <stdexcept>
#include <string>

namespace ironbird::hil_bridge {

namespace {

constexpr Time kHeartbeatPeriod{1'000'000'000};

}  // namespace

Lockstep::Lockstep(Fcu& fcu, autopilot::Autopilot& pilot, Guard& guard, Time period)
    : fcu_(fcu), tick_(fcu, pilot, guard), period_(period) {
  if (period.count() <= 0) {
    throw std::invalid_argument("lockstep.period = " + std::to_string(period.count()) + " ns, must be > 0");
  }
}

Time Lockstep::tick(bool in_time) {
  now_ += period_;
  if (now_ >= next_heartbeat_) {
    fcu_.send(rosflight::Heartbeat{.mavlink_version = rosflight::kDialectVersion});
    next_heartbeat_ += kHeartbeatPeriod;
  }
  tick_.run(now_, in_time);
  return now_;
}

}  // namespace ironbird::hil_bridge
