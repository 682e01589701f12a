#include "hil_bridge/interlock/interlock.hpp"

namespace ironbird::hil_bridge {

namespace {

constexpr std::uint8_t kSendVersion = 10;

bool changes_the_unit(const rosflight::Message& message) {
  if (std::holds_alternative<rosflight::ParamSet>(message)) return true;
  const auto* order = std::get_if<rosflight::RosflightCmd>(&message);
  return order != nullptr && order->command != kSendVersion;
}

}  // namespace

Interlock::Interlock(const InterlockConfig& config) : config_(config), check_(config.limits) {}

const InterlockStatus& Interlock::step(InterlockInputs in, Time now) {
  unit_disarmed_ = in.unit_disarmed && !in.unit_armed;
  in.commands_sound = in.commands_sound && !refused_too_long(now);
  const InterlockRow* const row = deciding_row(status_.state, in);
  if (row == nullptr) return status_;
  if (row->to == InterlockState::kLive) last_passed_ = now;
  status_.state = row->to;
  status_.why = row->why;
  status_.since = now;
  return status_;
}

bool Interlock::refused_too_long(Time now) const {
  return status_.state == InterlockState::kLive && now - last_passed_ > config_.unit_timeout / 2;
}

std::optional<rosflight::OffboardControl> Interlock::command(const StampedCommand& wanted, Time now) {
  if (status_.state != InterlockState::kLive) return idle();
  const CommandFault fault = check_.check(wanted, now);
  if (fault != CommandFault::kNone) {
    ++status_.refused[static_cast<std::size_t>(fault)];
    return std::nullopt;
  }
  ++status_.passed;
  last_passed_ = now;
  return wanted.command;
}

std::optional<rosflight::OffboardControl> Interlock::idle() const {
  const bool silent =
      status_.state != InterlockState::kReleased &&
      (status_.state != InterlockState::kKilled || config_.profile == InterlockProfile::kFlight);
  return silent ? std::nullopt : std::optional(zero_command());
}

std::optional<rosflight::Message> Interlock::pass(const rosflight::Message& message, Time) {
  if (std::holds_alternative<rosflight::OffboardControl>(message)) return std::nullopt;
  // It never times out, and a "servo" at its centre is half throttle to a speed controller. The bench needs
  // none.
  if (std::holds_alternative<rosflight::RosflightAuxCmd>(message)) return std::nullopt;
  const bool released = status_.state == InterlockState::kReleased || status_.state == InterlockState::kLive;
  if (changes_the_unit(message) && (released || !unit_disarmed_)) return std::nullopt;
  return message;
}

}  // namespace ironbird::hil_bridge
