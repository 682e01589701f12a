// The part of the bench that carries out the scenario's script.

#include <string>

#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"

namespace ironbird::scenarios {

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
    case Deed::Kind::kArm:
      return perform(PilotAction::kArm);
    case Deed::Kind::kHandOver:
      return perform(PilotAction::kHandOver);
    case Deed::Kind::kTakeOff:
      operator_->ask(autopilot::TakeOff{}, "take_off", now);
      return;
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
  if (event.pilot) {
    judge_->event(now, "pilot", describe_event(event));
    if (*event.pilot == PilotAction::kMoveThrottle) {
      return fcu_->pilot().set_stick(hil_bridge::Stick::kThrottle, event.magnitude);
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

void Bench::perform(PilotAction action) {
  hil_bridge::RcPilot& pilot = fcu_->pilot();
  switch (action) {
    case PilotAction::kArm:
      guard_->want({.release = true});
      return pilot.arm(true);
    case PilotAction::kDisarm:
      guard_->want({});
      return pilot.arm(false);
    case PilotAction::kTakeOver:
      return pilot.override_companion(true);
    case PilotAction::kHandOver:
      return pilot.override_companion(false);
    case PilotAction::kMoveThrottle:
      return;
    case PilotAction::kLoseRadio:
      return pilot.lose();
    case PilotAction::kFindRadio:
      return pilot.find();
  }
}

}  // namespace ironbird::scenarios
