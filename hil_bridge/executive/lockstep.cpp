#include "hil_bridge/executive/lockstep.hpp"

#include <stdexcept>
#include <string>

#include "hil_bridge/translate/command_encoder.hpp"

namespace ironbird::hil_bridge {

namespace {

constexpr Time kHeartbeatPeriod{1'000'000'000};
// A tick brings a handful of messages; the reserve keeps the step free of allocation.
constexpr std::size_t kInboxReserve = 512;

}  // namespace

Lockstep::Lockstep(Fcu& fcu, autopilot::Autopilot& pilot, Time period)
    : fcu_(fcu), pilot_(pilot), period_(period) {
  if (period.count() <= 0) {
    throw std::invalid_argument("lockstep.period = " + std::to_string(period.count()) + " ns, must be > 0");
  }
  inbox_.reserve(kInboxReserve);
  texts_.reserve(kInboxReserve);
}

Time Lockstep::tick() {
  now_ += period_;
  stepped_ = false;
  if (now_ >= next_heartbeat_) {
    fcu_.send(rosflight::Heartbeat{.mavlink_version = rosflight::kDialectVersion});
    next_heartbeat_ += kHeartbeatPeriod;
  }
  fcu_.advance(now_);
  inbox_.clear();
  texts_.clear();
  fcu_.receive(inbox_);
  for (const Arrival& arrival : inbox_) dispatch(arrival);
  return now_;
}

void Lockstep::dispatch(const Arrival& arrival) {
  telemetry_.take(arrival.message);
  if (const auto* text = std::get_if<rosflight::Statustext>(&arrival.message)) texts_.push_back(*text);
  const autopilot::SensorFrame* frame = builder_.push(arrival);
  if (frame == nullptr) return;
  stepped_ = true;
  if (const auto control = encode(pilot_.step(*frame))) fcu_.send(*control);
}

}  // namespace ironbird::hil_bridge
