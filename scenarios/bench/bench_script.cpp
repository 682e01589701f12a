// The part of the bench that carries out the scenario's script.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/bench/waypoint_text.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

autopilot::Request request_of(OperatorWish wish, const EventConfig& event) {
  switch (wish) {
    case OperatorWish::kTakeOff:
      return autopilot::TakeOff{};
    case OperatorWish::kLand:
      return autopilot::Land{};
    case OperatorWish::kResume:
      return autopilot::Resume{};
    case OperatorWish::kHold:
      return autopilot::RouteRequest(
          autopilot::HoldHere{event.magnitude > 0.0 ? std::optional<double>(event.magnitude) : std::nullopt});
    case OperatorWish::kRelease:
      return autopilot::RouteRequest(autopilot::Release{});
    case OperatorWish::kReturnToLaunch:
      return autopilot::RouteRequest(autopilot::ReturnToLaunch{});
    case OperatorWish::kClearRoute:
      return autopilot::RouteRequest(autopilot::ClearRoute{});
    case OperatorWish::kListRoute:
      return autopilot::ListRoute{};
    case OperatorWish::kFollowerFlies:
      return autopilot::OverrideSetpoint{std::nullopt};
  }
  throw std::invalid_argument("event.request: unknown");
}

/// A scenario gives every value as a number; truths and whole numbers are converted to what the module has.
autopilot::ParameterValue in_type_of(const autopilot::ParameterSlot* slot, double value) {
  if (slot != nullptr && std::holds_alternative<bool*>(slot->value)) return value != 0.0;
  if (slot != nullptr && std::holds_alternative<int*>(slot->value))
    return static_cast<int>(std::lround(value));
  return value;
}

/// Says of the whole run that the vehicle stays on the ground.
bool forbids_flight(const CheckConfig& check) {
  if (!check.none_of_events || !check.after.empty() || !check.until.empty()) return false;
  const std::string in_full = "ground:" + std::string(kLiftedOff);
  return std::any_of(check.none_of_events->begin(), check.none_of_events->end(),
                     [&](const std::string& name) { return name == kLiftedOff || name == in_full; });
}

constexpr std::string_view kRefused = "refused";

/// Names a refusal, or any.
bool expects_refusal(const CheckConfig& check) {
  const auto is_refusal = [](const std::string& event) { return event.starts_with(kRefused); };
  const auto names_one = [&](const std::optional<std::vector<std::string>>& events) {
    return events && std::any_of(events->begin(), events->end(), is_refusal);
  };
  return names_one(check.order_of_events) || names_one(check.none_of_events) || is_refusal(check.after) ||
         is_refusal(check.until);
}

/// The take-off that the pilot asks for by himself; a vehicle that takes off when it is armed needs none.
bool is_the_pilots_own(const RunEvent& refusal, const Scenario& scenario) {
  const double late = refusal.time - scenario.pilot.take_off_at;
  return scenario.pilot.automatic && refusal.text.starts_with("take_off:") &&
         std::abs(late) <= to_seconds(scenario.fcu.tick);
}

std::string about_refusal(const RunEvent& refusal) {
  return "request at " + with_unit(refusal.time, "s") + " was refused: " + refusal.text;
}

std::string why_left(const Script::Left& left) {
  if (!left.due) return " waited for \"" + left.after + "\", which never happened";
  return " was due at " + with_unit(to_seconds(*left.due), "s") + ", after the end of the run";
}

}  // namespace

void Bench::do_what_is_due(Time now) {
  while (const auto item = script_.next_due(now)) perform(deeds_[*item], now);
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
      ask(autopilot::TakeOff{}, "take_off", now);
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
  if (event.request) return perform(*event.request, event, now);
  if (event.setpoint) {
    ask(autopilot::OverrideSetpoint{only_setpoint(*event.setpoint)}, describe_event(event), now);
    return;
  }
  if (event.add_waypoint) {
    std::optional<std::uint32_t> at;
    if (event.index) at = static_cast<std::uint32_t>(*event.index);
    ask(autopilot::RouteRequest(autopilot::AddWaypoint{*event.add_waypoint, at}), describe_event(event), now);
    return;
  }
  if (event.remove_waypoint) {
    const auto index = static_cast<std::uint32_t>(*event.remove_waypoint);
    ask(autopilot::RouteRequest(autopilot::RemoveWaypoint{index}), describe_event(event), now);
    return;
  }
  if (!event.swap.empty()) return swap_module(event, now);
  const autopilot::ParameterSlot* slot = autopilot_->parameters().find(event.set);
  ask(autopilot::SetParameter{event.set, in_type_of(slot, event.value)}, describe_event(event), now);
}

void Bench::begin_fault(const EventConfig& event, Time now) {
  const int number = world_->begin(fault_of(event));
  judge_->event(now, "fault", describe_event(event));
  if (event.lasts > 0.0) {
    running_faults_[static_cast<std::size_t>(number)] = describe_event(event);
    script_.add("", now + from_seconds(event.lasts));
    deeds_.push_back({Deed::Kind::kFaultEnd, static_cast<std::size_t>(number)});
  }
}

void Bench::perform(PilotAction action) {
  hil_bridge::RcPilot& pilot = fcu_->pilot();
  switch (action) {
    case PilotAction::kArm:
      return pilot.arm(true);
    case PilotAction::kDisarm:
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

void Bench::perform(OperatorWish wish, const EventConfig& event, Time now) {
  ask(request_of(wish, event), describe_event(event), now);
}

void Bench::swap_module(const EventConfig& event, Time now) {
  autopilot::SwapModule wish{event.swap, event.kind};
  if (const ModuleSettings* settings = loaded_.settings_of(event.swap, event.kind)) {
    wish.settings = settings->values;
  }
  if (!ask(wish, describe_event(event), now)) return;
  autopilot::for_each_slot([&](const auto& slot) {
    if (probes_ && event.swap == slot.name)
      probes_->watch(event.swap, event.kind, (*autopilot_.*slot.module)());
  });
}

bool Bench::ask(const autopilot::Request& request, const std::string& what, Time now) {
  const autopilot::RequestOutcome outcome = autopilot_->request(request);
  if (judge_ == nullptr) {
    if (!outcome.accepted)
      throw std::invalid_argument("waypoint: the planner refuses the route: " + outcome.reason);
    return true;
  }
  judge_->event(now, outcome.accepted ? "request" : std::string(kRefused),
                outcome.accepted ? what : what + ": " + outcome.reason);
  for (std::size_t i = 0; i < outcome.waypoints.size(); ++i)
    judge_->event(now, "answer", line_about(outcome.waypoints[i], i));
  return outcome.accepted;
}

std::string Bench::name_of(const Deed& deed) const {
  switch (deed.kind) {
    case Deed::Kind::kEvent:
      return "event \"" + describe_event(scenario_.events[deed.index]) + "\"";
    case Deed::Kind::kSnapshot:
      return "snapshot \"" + scenario_.snapshots[deed.index].name + "\"";
    case Deed::Kind::kEnd:
      return "the end of the run";
    default:
      return "";  // the bench's own
  }
}

/// What the scenario says and did not happen, so that its checks show nothing.
std::vector<std::string> Bench::gaps() const {
  std::vector<std::string> gaps;
  const std::vector<RunEvent>& seen = judge_->events();
  const bool flew = std::any_of(seen.begin(), seen.end(), [](const RunEvent& event) {
    return event.kind == "ground" && event.text == kLiftedOff;
  });
  const auto& checks = scenario_.checks;
  if (!flew && std::none_of(checks.begin(), checks.end(), forbids_flight)) {
    gaps.push_back("the vehicle never left the ground; if it should not, say so: none_of_events = [\"" +
                   std::string(kLiftedOff) + "\"]");
  }
  for (const Script::Left& left : script_.left()) {
    const Deed& deed = deeds_[left.item];
    if (deed.kind == Deed::Kind::kEvent && !scenario_.events[deed.index].optional)
      gaps.push_back(name_of(deed) + why_left(left) + "; if it need not come, say so: optional = true");
  }
  if (std::any_of(checks.begin(), checks.end(), expects_refusal)) return gaps;
  for (const RunEvent& event : seen) {
    if (event.kind == kRefused && !is_the_pilots_own(event, scenario_)) {
      gaps.push_back(about_refusal(event) + "; if it should be, let a check name it: order_of_events = [\"" +
                     std::string(kRefused) + "\"]");
    }
  }
  return gaps;
}

std::vector<std::string> Bench::warnings() const {
  std::vector<std::string> warnings;
  for (const Script::Left& left : script_.left()) {
    const Deed& deed = deeds_[left.item];
    const bool is_end = deed.kind == Deed::Kind::kEnd;
    if (deed.kind == Deed::Kind::kSnapshot)
      warnings.push_back(name_of(deed) + why_left(left) + ": not taken");
    if (is_end && !left.due) warnings.push_back(name_of(deed) + why_left(left));
  }
  for (const RunEvent& event : judge_->events()) {
    if (event.kind == kRefused && is_the_pilots_own(event, scenario_))
      warnings.push_back(about_refusal(event));
  }
  return warnings;
}

}  // namespace ironbird::scenarios
