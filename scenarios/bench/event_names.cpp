#include "scenarios/bench/event_names.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

#include "autopilot/types/flight_status.hpp"
#include "autopilot/types/state_estimate.hpp"
#include "hil_bridge/transport/frame_bus.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "scenarios/config/nearest_name.hpp"
#include "scenarios/requirements/timeline.hpp"
#include "scenarios/requirements/window.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::string_view kWaypoint = "waypoint_";
constexpr std::string_view kOfFcu = "fcu:";
/// What the bench puts in front of what happens when the scenario wants it or asks for it.
constexpr std::array<std::string_view, 9> kKindsOfDeeds{
    "request", kRefusedEvent, "answer", "pilot", "fault", "fault_end", "snapshot", "fcu", "interlock"};
/// Its text says why: a check names the kind.
constexpr std::string_view kKilled = "killed";
/// A return to launch is a route of two waypoints of its own.
constexpr std::size_t kReturnWaypoints = 2;

template <class Test>
bool any_event(const Scenario& scenario, Test test) {
  return std::any_of(scenario.events.begin(), scenario.events.end(), test);
}

bool somebody_arms(const Scenario& scenario) {
  return scenario.pilot.automatic ||
         any_event(scenario, [](const EventConfig& event) { return event.pilot == PilotAction::kArm; });
}

bool asks_for(const Scenario& scenario, OperatorWish wish) {
  return any_event(scenario, [&](const EventConfig& event) { return event.request == wish; });
}

/// A check that waits for it waits for this and nothing else.
bool is_whole_moment(const std::string& name) {
  try {
    return Moment::read(name, "name").event == name;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

std::size_t longest_mission(const Scenario& scenario) {
  std::size_t count = scenario.waypoints.size();
  for (const EventConfig& event : scenario.events) count += event.add_waypoint ? 1 : 0;
  return count;
}

std::size_t longest_route(const Scenario& scenario) {
  const std::size_t count = longest_mission(scenario);
  return asks_for(scenario, OperatorWish::kReturnToLaunch) ? std::max(count, kReturnWaypoints) : count;
}

std::size_t reachable_waypoints(const Scenario& scenario) {
  const auto times = [&](OperatorWish wish) {
    return static_cast<std::size_t>(
        std::count_if(scenario.events.begin(), scenario.events.end(),
                      [&](const EventConfig& event) { return event.request == wish; }));
  };
  const std::size_t take_offs = times(OperatorWish::kTakeOff) + (scenario.pilot.automatic ? 1 : 0);
  return longest_mission(scenario) * std::max<std::size_t>(take_offs, 1) +
         kReturnWaypoints * times(OperatorWish::kReturnToLaunch);
}

std::string stand_event(std::size_t motor, bool ready) {
  return "motor " + std::to_string(motor) + (ready ? " is ready" : " is not ready");
}

EventNames::EventNames(const Scenario& scenario) {
  if (!scenario.cyclic) waypoints_ = reachable_waypoints(scenario);
  add_flight(scenario);
  add_waypoints(scenario);
  of_the_run_ = names_.size();
  add_own(scenario);
}

void EventNames::add_flight(const Scenario& scenario) {
  for (const auto& [value, name] : enumerators(autopilot::Health{}))
    names_.push_back({"health", std::string(name)});
  for (const std::string_view name : kGroundEvents) names_.push_back({"ground", std::string(name)});
  for (const std::string_view name : kDoubtEvents) names_.push_back({"position", std::string(name)});
  if (scenario.fcu.kind == FcuKind::kHil && scenario.fcu.motors != kOutputRaw) {
    add_bus("can");
  }
  if (!scenario.fcu.stand.empty()) add_stand(scenario);
  if (!somebody_arms(scenario)) return;
  names_.push_back({"arming", "armed"});
  names_.push_back({"arming", "unarmed"});
  for (const auto& [value, name] : enumerators(autopilot::FlightPhase{}))
    names_.push_back({"phase", std::string(name)});
  for (const auto& [value, name] : enumerators(autopilot::PhaseCause{}))
    names_.push_back({"cause", std::string(name)});
  if (!scenario.pilot.automatic) return;
  names_.push_back({"request", "take_off"});
  names_.push_back({std::string(kRefusedEvent), "take_off"});
}

void EventNames::add_bus(const std::string& kind) {
  for (std::size_t k = 0; k < hil_bridge::transport::kBusEventKinds; ++k) {
    const auto event = static_cast<hil_bridge::transport::BusEventKind>(k);
    names_.push_back({kind, std::string(name_of(event))});
  }
}

void EventNames::add_stand(const Scenario& scenario) {
  add_bus("stand");
  for (std::size_t motor = 0; motor < scenario.vehicle.rotors.size(); ++motor) {
    for (const bool ready : {true, false}) names_.push_back({"stand", stand_event(motor, ready)});
  }
}

void EventNames::add_waypoints(const Scenario& scenario) {
  const bool ends = !scenario.cyclic || asks_for(scenario, OperatorWish::kClearRoute) ||
                    asks_for(scenario, OperatorWish::kReturnToLaunch);
  if (waypoints_ != std::size_t{0}) names_.push_back({"waypoint", "waypoint_1"});
  if (ends && waypoints_ != std::size_t{0}) names_.push_back({"waypoint", "route_finished"});
}

/// An event of the scenario can happen when what it waits for can; which may be another one of them.
void EventNames::add_own(const Scenario& scenario) {
  for (const SnapshotConfig& snapshot : scenario.snapshots)
    names_.push_back({"snapshot", picture_event(snapshot.name)});
  std::vector<bool> possible(scenario.events.size(), false);
  for (bool news = true; news;) {
    news = false;
    for (std::size_t i = 0; i < possible.size(); ++i) {
      const EventConfig& event = scenario.events[i];
      if (possible[i] || (!event.after.empty() && !known(event.after, Waiting::kDeed))) continue;
      possible[i] = news = true;
      add_deed(event);
    }
  }
  for (std::size_t i = 0; i < possible.size(); ++i) {
    if (!possible[i]) in_circles_.push_back(describe_event(scenario.events[i]));
  }
}

void EventNames::add_deed(const EventConfig& event) {
  const std::string text = describe_event(event);
  if (event.fault || event.link || event.bus) {
    names_.push_back({"fault", text});
    if (event.lasts > 0.0) names_.push_back({"fault_end", text});
  } else {
    names_.push_back({event.pilot ? "pilot" : "request", text});
    if (!event.pilot) names_.push_back({std::string(kRefusedEvent), text});
  }
}

bool EventNames::is_waypoint(std::string_view name) const {
  if (name.starts_with("waypoint:")) name.remove_prefix(std::string_view("waypoint:").size());
  if (!name.starts_with(kWaypoint)) return false;
  name.remove_prefix(kWaypoint.size());
  std::size_t number = 0;
  const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = read.ec == std::errc() && read.ptr == name.data() + name.size();
  return is_number && number >= 1 && name.front() != '0' && (!waypoints_ || number <= *waypoints_);
}

bool EventNames::known(const std::string& name, Waiting waiting) const {
  const auto is_name = [&](std::string_view one) { return one == name; };
  const bool is_kind = std::ranges::any_of(kPositionEvents, is_name) || name == kKilled;
  if (waiting == Waiting::kCheck && is_kind) return true;
  if ((name.starts_with(kOfFcu) && name.size() > kOfFcu.size()) || is_waypoint(name)) return true;
  return std::any_of(names_.begin(), names_.end(), [&](const Name& n) {
    return name == n.text || (waiting == Waiting::kCheck && name == n.kind) || name == n.kind + ":" + n.text;
  });
}

std::string EventNames::objection(const std::string& name) const {
  if (name.find(':') != std::string::npos) return "must be without ':', which stands behind a kind of event";
  if (!is_whole_moment(name))
    return "must neither begin with a number nor have a '+': times are written so in `after` and `until`";
  const auto is_name = [&](std::string_view one) { return one == name; };
  const auto end = names_.begin() + static_cast<std::ptrdiff_t>(of_the_run_);
  const bool taken =
      std::ranges::any_of(kKindsOfDeeds, is_name) || std::ranges::any_of(kPositionEvents, is_name) ||
      name == kKilled || is_waypoint(name) || std::any_of(names_.begin(), end, [&](const Name& n) {
        return n.kind != "request" && n.kind != kRefusedEvent && (name == n.text || name == n.kind);
      });
  return taken ? "the run itself has events of this name; must be another" : "";
}

std::vector<std::string> EventNames::spoken(Waiting waiting) const {
  std::vector<std::string> all;
  if (waiting == Waiting::kCheck) {
    all.assign(kPositionEvents.begin(), kPositionEvents.end());
    all.emplace_back(kKilled);
  }
  for (const Name& name : names_) {
    // What begins and what ends a fault have one text, as a request and its refusal: the kind tells them
    // apart.
    const bool needs_kind = name.kind == "fault_end" || name.kind == kRefusedEvent;
    all.push_back(needs_kind ? name.kind + ":" + name.text : name.text);
    if (waiting == Waiting::kCheck) all.push_back(name.kind);
  }
  return all;
}

std::string EventNames::complaint(const std::string& name, Waiting waiting) const {
  if (known(name, waiting)) return "";
  if (std::find(in_circles_.begin(), in_circles_.end(), name) != in_circles_.end())
    return "can never happen, because what it waits for never does";
  if (name.starts_with(kWaypoint) && waypoints_) {
    return "there is no such event: the route " + (*waypoints_ == 0
                                                       ? std::string("has no waypoint")
                                                       : "ends at waypoint_" + std::to_string(*waypoints_));
  }
  const std::vector<std::string> names = spoken(waiting);
  const std::string nearest = nearest_name(name, names);
  if (!nearest.empty()) return "there is no such event; did you mean '" + nearest + "'?";
  std::string all;
  for (const std::string& candidate : names) {
    if (all.find(candidate) == std::string::npos) all += (all.empty() ? "" : ", ") + candidate;
  }
  return "there is no such event; there are " + all;
}

}  // namespace ironbird::scenarios
