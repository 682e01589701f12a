#include "hil_bridge/interlock/interlock.hpp"

namespace ironbird::hil_bridge {

Interlock::Interlock(const InterlockConfig& config) : config_(config), check_(config.limits) {}

const InterlockStatus& Interlock::step(InterlockInputs in, Time now) {
  unit_disarmed_ = in.unit_disarmed && !in.unit_armed;
  in.commands_sound = in.commands_sound && !refused_too_long();
  const InterlockRow* const row = deciding_row(status_.state, in);
  if (row == nullptr) return status_;
  if (row->to == InterlockState::kLive) refused_since_.reset();
  status_.state = row->to;
  status_.why = row->why;
  status_.since = now;
  return status_;
}

bool Interlock::refused_too_long() const {
  return refused_since_ && refused_last_ - *refused_since_ >= config_.unit_timeout / 2;
}

void Interlock::refuse(CommandFault fault, Time now) {
  ++status_.refused[static_cast<std::size_t>(fault)];
  if (status_.state != InterlockState::kLive) return;
  if (!refused_since_) refused_since_ = now;
  refused_last_ = now;
}

std::optional<rosflight::OffboardControl> Interlock::command(const StampedCommand& wanted, Time now) {
  if (status_.state != InterlockState::kLive) return idle();
  const CommandFault fault = check_.check(wanted, now);
  if (fault != CommandFault::kNone) {
    refuse(fault, now);
    return std::nullopt;
  }
  ++status_.passed;
  refused_since_.reset();
  return wanted.command;
}

std::optional<rosflight::OffboardControl> Interlock::idle() const {
  const bool silent =
      status_.state != InterlockState::kReleased &&
      (status_.state != InterlockState::kKilled || config_.profile == InterlockProfile::kFlight);
  return silent ? std::nullopt : std::optional(zero_command());
}

std::optional<rosflight::Message> Interlock::pass(const rosflight::Message& message, Time) {
  const Effect effect = effect_of(message);
  // An auxiliary command never times out, and a "servo" at its centre is half throttle to a speed controller:
  // the bench sends none. Any other motor command has a stamp and goes through `command`.
  if (effect == Effect::kMoves) return std::nullopt;
  const bool released = status_.state == InterlockState::kReleased || status_.state == InterlockState::kLive;
  if (effect == Effect::kChanges && (released || !unit_disarmed_)) return std::nullopt;
  return message;
}

}  // namespace ironbird::hil_bridge
