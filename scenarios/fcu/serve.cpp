#include "scenarios/fcu/serve.hpp"

#include <string_view>

#include "hil_bridge/virtual_fcu/parameter_table.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/world_maker.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
using hil_bridge::VirtualFcu;

std::uint8_t system_of(const VirtualFcu& fcu) {
  return static_cast<std::uint8_t>(
      fcu.firmware().parameters().integer(hil_bridge::virtual_fcu::find_parameter("SYS_ID")));
}

}  // namespace

ServedUnit::ServedUnit(const Scenario& scenario, hil_bridge::transport::ByteStream& line,
                       hil_bridge::transport::FrameBus* bus)
    : scenario_(scenario),
      world_(make_world(scenario)),
      fcu_(scenario.fcu, *world_),
      served_(fcu_, line, system_of(fcu_)) {
  if (bus != nullptr) motors_.emplace(static_cast<int>(scenario.vehicle.rotors.size()), *bus, Time{0});
}

void ServedUnit::tick() {
  now_ += scenario_.fcu.tick;
  served_.take();
  if (!since_ && served_.frames_taken() > 0) since_ = now_;
  if (scenario_.pilot.automatic && since_) act_as_pilot();
  fcu_.advance(now_);
  if (motors_) motors_->step(fcu_, now_);
  served_.give();
  const std::optional<std::string_view> event = ground_.observe(world_->truth());
  if (event && *event != std::string_view("lifted_off")) down_ = now_;
}

void ServedUnit::act_as_pilot() {
  const Time present = now_ - *since_;
  const Time arm_at = from_seconds(scenario_.pilot.arm_at);
  if (!armed_ && present >= arm_at) {
    armed_ = true;
    fcu_.pilot().arm(true);
  }
  if (!handed_over_ && present >= arm_at + from_seconds(PilotConfig::kHandOverDelay)) {
    handed_over_ = true;
    fcu_.pilot().override_companion(false);
  }
  if (down_ && now_ >= *down_ + from_seconds(PilotConfig::kDisarmDelay) && !ground_.airborne())
    fcu_.pilot().arm(false);
}

}  // namespace ironbird::scenarios
