// The part of the bench that carries out the scenario's script.

#include <string>

#include "hil_bridge/interlock/interlock_state.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/hil_rig.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::nanoseconds kAskAgain = std::chrono::milliseconds(50);

}  // namespace

void Bench::do_what_is_due(Time now) {
  while (const auto deed = playbook_.next_due(now)) perform(*deed, now);
}

void Bench::perform(const Deed& deed, Time now) {
  switch (deed.kind) {
    case Deed::Kind::kEvent:
      return perform(scenario_.events[deed.index], now);
    case Deed::Kind::kFaultEnd:
      world_->end(static_cast<int>(deed.index));
      return judge_->event(now, "fault_end", running_faults_[deed.index]);
    case Deed::Kind::kLinkFaultEnd:
      return end_link_fault(deed.index, now);
    case Deed::Kind::kArm:
      return perform(PilotAction::kArm);
    case Deed::Kind::kHandOver:
      return perform(PilotAction::kHandOver);
    case Deed::Kind::kTakeOff:
      return ask_for_take_off(now);
    case Deed::Kind::kDisarm:
      // A pilot whose vehicle has left the ground again leaves the switch alone.
      if (!ground_.airborne()) perform(PilotAction::kDisarm);
      return;
    case Deed::Kind::kSnapshot:
      return judge_->event(now, "snapshot", picture_event(scenario_.snapshots[deed.index].name));
    case Deed::Kind::kEnd:
      ended_ = true;
      return;
  }
}

void Bench::perform(const EventConfig& event, Time now) {
  if (event.fault) return begin_fault(event, now);
  if (event.link || event.bus) return begin_link_fault(event, now);
  if (event.pilot) {
    judge_->event(now, "pilot", describe_event(event));
    if (*event.pilot == PilotAction::kMoveThrottle) {
      if (pilot() != nullptr) pilot()->set_stick(hil_bridge::Stick::kThrottle, event.magnitude);
      return;
    }
    return perform(*event.pilot);
  }
  operator_->perform(event, now);
}

void Bench::begin_fault(const EventConfig& event, Time now) {
  const int number = world_->begin(fault_of(event));
  judge_->event(now, "fault", describe_event(event));
  if (event.lasts > 0.0) {
    running_faults_[static_cast<std::size_t>(number)] = describe_event(event);
    playbook_.add_at(now + from_seconds(event.lasts),
                     {Deed::Kind::kFaultEnd, static_cast<std::size_t>(number)});
  }
}

void Bench::begin_link_fault(const EventConfig& event, Time now) {
  const auto number = static_cast<std::size_t>(&event - scenario_.events.data());
  const Time end = now + from_seconds(event.lasts);
  if (event.link) link_faults_.begin(number, *event.link, event.magnitude, end, line_faults());
  if (event.bus) bus_faults_.begin(number, *event.bus, event.magnitude, end, *rig_->bus_faults());
  judge_->event(now, "fault", describe_event(event));
  if (event.lasts > 0.0) playbook_.add_at(end, {Deed::Kind::kLinkFaultEnd, number});
}

void Bench::end_link_fault(std::size_t number, Time now) {
  const EventConfig& event = scenario_.events[number];
  if (event.link) link_faults_.end(number, line_faults());
  if (event.bus) bus_faults_.end(number, *rig_->bus_faults());
  judge_->event(now, "fault_end", describe_event(event));
}

/// A simulated pilot has armed by now. One of flesh and blood does so when they like: the wish is repeated
/// until it is granted.
void Bench::ask_for_take_off(Time now) {
  if (pilot() != nullptr) {
    operator_->ask(autopilot::TakeOff{}, "take_off", now);
  } else if (!operator_->ask_until_granted(autopilot::TakeOff{}, "take_off", now)) {
    playbook_.add_at(now + kAskAgain, {Deed::Kind::kTakeOff, 0});
  }
}

/// At once, and not with the next tick: in that the unit may be armed already, and an armed unit is not
/// released.
void Bench::release_gate() {
  const Time now = lockstep_->now();
  guard_->want({.release = true});
  const auto state = guard_->step(autopilot_->signals().estimate, /*bench_in_time=*/true, now).state;
  if (state == hil_bridge::InterlockState::kReleased || state == hil_bridge::InterlockState::kLive) return;
  judge_->event(now, "interlock", "not released: " + what_is_missing(guard_->inputs()));
}

void Bench::perform(PilotAction action) {
  if (action == PilotAction::kArm) release_gate();
  if (action == PilotAction::kDisarm) guard_->want({});
  if (pilot() == nullptr) return;
  hil_bridge::RcPilot& hands = *pilot();
  switch (action) {
    case PilotAction::kArm:
      return hands.arm(true);
    case PilotAction::kDisarm:
      return hands.arm(false);
    case PilotAction::kTakeOver:
      return hands.override_companion(true);
    case PilotAction::kHandOver:
      return hands.override_companion(false);
    case PilotAction::kMoveThrottle:
      return;
    case PilotAction::kLoseRadio:
      return hands.lose();
    case PilotAction::kFindRadio:
      return hands.find();
  }
}

}  // namespace ironbird::scenarios
