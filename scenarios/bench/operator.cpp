#include "scenarios/bench/operator.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/bench/waypoint_text.hpp"

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

}  // namespace

std::unique_ptr<autopilot::Autopilot> make_autopilot(const LoadedScenario& loaded,
                                                     const autopilot::Modules& modules) {
  auto pilot = std::make_unique<autopilot::Autopilot>(loaded.autopilot, modules);
  autopilot::for_each_slot([&](const auto& slot) {
    const ModuleSettings* settings =
        loaded.settings_of(std::string(slot.name), (loaded.autopilot.*slot.config).kind);
    if (settings != nullptr) pilot->parameters().set_all(settings->values);
  });
  if (loaded.scenario.waypoints.empty()) return pilot;
  const autopilot::RequestOutcome outcome = pilot->request(
      autopilot::RouteRequest(autopilot::SetRoute{loaded.scenario.waypoints, loaded.scenario.cyclic}));
  if (!outcome.accepted)
    throw std::invalid_argument("waypoint: the planner refuses the route: " + outcome.reason);
  return pilot;
}

void Operator::perform(const EventConfig& event, Time now) {
  const std::string what = describe_event(event);
  if (event.request) {
    ask(request_of(*event.request, event), what, now);
  } else if (event.setpoint) {
    ask(autopilot::OverrideSetpoint{only_setpoint(*event.setpoint)}, what, now);
  } else if (event.add_waypoint) {
    std::optional<std::uint32_t> at;
    if (event.index) at = static_cast<std::uint32_t>(*event.index);
    ask(autopilot::RouteRequest(autopilot::AddWaypoint{*event.add_waypoint, at}), what, now);
  } else if (event.remove_waypoint) {
    const auto index = static_cast<std::uint32_t>(*event.remove_waypoint);
    ask(autopilot::RouteRequest(autopilot::RemoveWaypoint{index}), what, now);
  } else if (!event.swap.empty()) {
    swap_module(event, now);
  } else {
    const autopilot::ParameterSlot* slot = pilot_.parameters().find(event.set);
    ask(autopilot::SetParameter{event.set, in_type_of(slot, event.value)}, what, now);
  }
}

void Operator::swap_module(const EventConfig& event, Time now) {
  autopilot::SwapModule wish{event.swap, event.kind};
  if (const ModuleSettings* settings = loaded_.settings_of(event.swap, event.kind)) {
    wish.settings = settings->values;
  }
  if (!ask(wish, describe_event(event), now) || !on_swap_) return;
  autopilot::for_each_slot([&](const auto& slot) {
    if (event.swap == slot.name) on_swap_(event.swap, event.kind, (pilot_.*slot.module)());
  });
}

autopilot::RequestOutcome Operator::put(const autopilot::Request& request, Time now) {
  autopilot::RequestOutcome outcome = pilot_.request(request);
  if (on_request_) on_request_(request, outcome, now);
  return outcome;
}

bool Operator::ask_until_granted(const autopilot::Request& request, const std::string& what, Time now) {
  const bool accepted = put(request, now).accepted;
  if (accepted) judge_.event(now, "request", what);
  return accepted;
}

bool Operator::ask(const autopilot::Request& request, const std::string& what, Time now) {
  const autopilot::RequestOutcome outcome = put(request, now);
  judge_.event(now, outcome.accepted ? "request" : std::string(kRefusedEvent),
               outcome.accepted ? what : what + ": " + outcome.reason);
  for (std::size_t i = 0; i < outcome.waypoints.size(); ++i)
    judge_.event(now, "answer", line_about(outcome.waypoints[i], i));
  return outcome.accepted;
}

}  // namespace ironbird::scenarios
