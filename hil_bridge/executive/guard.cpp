#include "hil_bridge/executive/guard.hpp"

#include <algorithm>

#include "hil_bridge/translate/command_encoder.hpp"

namespace ironbird::hil_bridge {

const InterlockStatus& Guard::step(const autopilot::StateEstimate& estimate, bool bench_in_time, Time now) {
  inputs_ = {};
  watch_.report(now, inputs_);
  inputs_.estimate_usable = autopilot::is_usable(estimate.health);
  inputs_.bench_in_time = bench_in_time;
  inputs_.watchdog_awake = watchdog_awake_;
  inputs_.release_wanted = wishes_.release;
  inputs_.reset_wanted = wishes_.reset;
  inputs_.kill_wanted = wishes_.kill;
  return interlock_.step(inputs_, now);
}

std::optional<rosflight::OffboardControl> Guard::answer(const autopilot::FcuCommand& command, Time answers,
                                                        Time now) {
  const std::optional<rosflight::OffboardControl> control = encode(command);
  if (control) return approve({*control, std::min(answers, now), ++number_}, now);
  if (!std::holds_alternative<autopilot::SilenceCommand>(command)) {
    interlock_.refuse(CommandFault::kNotFinite, now);
  }
  return std::nullopt;
}

std::optional<rosflight::OffboardControl> Guard::unasked(Time now) {
  if (interlock_.status().state != InterlockState::kKilled) return std::nullopt;
  return approve({zero_command(), now, ++number_}, now);
}

std::optional<rosflight::OffboardControl> Guard::approve(const StampedCommand& wanted, Time now) {
  approved_ = interlock_.command(wanted, now);
  return approved_;
}

void Guard::close(Time now) {
  wishes_ = {.kill = true};
  InterlockInputs in = inputs_;
  in.kill_wanted = true;
  in.release_wanted = in.reset_wanted = false;
  interlock_.step(in, now);
  approved_.reset();
}

std::optional<rosflight::Message> Guard::pass(const rosflight::Message& message, Time now) {
  if (const auto* control = std::get_if<rosflight::OffboardControl>(&message)) {
    const bool approved = approved_ && approved_->u == control->u && approved_->mode == control->mode &&
                          approved_->ignore == control->ignore;
    approved_.reset();
    return approved ? std::optional(message) : std::nullopt;
  }
  return interlock_.pass(message, now);
}

}  // namespace ironbird::hil_bridge
