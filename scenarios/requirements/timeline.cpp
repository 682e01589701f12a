#include "scenarios/requirements/timeline.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "autopilot/math/local_map.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

template <class Enum>
std::string name_of(Enum value) {
  for (const auto& [candidate, name] : enumerators(value)) {
    if (candidate == value) return std::string(name);
  }
  return std::to_string(static_cast<int>(value));
}

constexpr std::string_view kWaypoint = "waypoint_";

/// Wishes, switches, texts and pictures: that they bear the name of something does not mean that it happened.
bool only_speaks(const RunEvent& event) {
  return event.kind == "request" || event.kind == kRefusedEvent || event.kind == "pilot" ||
         event.kind == "fcu" || event.kind == "snapshot";
}

/// True for the names that the flight itself gives to what happens in it.
bool is_of_the_flight(std::string_view name) {
  const auto is_one_of = [name](auto names) {
    return std::any_of(names.begin(), names.end(), [name](const auto& one) { return one.second == name; });
  };
  constexpr std::array<std::string_view, 3> kOthers{"armed", "unarmed", "route_finished"};
  const auto has = [name](const auto& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return is_one_of(enumerators(autopilot::FlightPhase{})) || is_one_of(enumerators(autopilot::Health{})) ||
         (name.starts_with(kWaypoint) &&
          name.find_first_not_of("0123456789", kWaypoint.size()) == name.npos) ||
         has(kGroundEvents) || has(kDoubtEvents) || has(kOthers);
}

}  // namespace

bool is_called(const RunEvent& event, std::string_view name) {
  if (name == event.kind) return true;
  const bool is_refusal = event.kind == kRefusedEvent;
  std::string_view text = event.text;
  if (is_refusal) text = text.substr(0, text.find(": "));
  if (name == text) return !is_refusal && !(only_speaks(event) && is_of_the_flight(name));
  return name.size() == event.kind.size() + 1 + text.size() && name.starts_with(event.kind) &&
         name[event.kind.size()] == ':' && name.ends_with(text);
}

std::optional<std::size_t> Timeline::find(std::string_view name, double from,
                                          const std::vector<std::size_t>& but_not) const {
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_[i].time < from || !is_called(events_[i], name)) continue;
    if (std::find(but_not.begin(), but_not.end(), i) == but_not.end()) return i;
  }
  return std::nullopt;
}

std::optional<double> Timeline::first(std::string_view name, double from) const {
  const std::optional<std::size_t> found = find(name, from);
  if (!found) return std::nullopt;
  return events_[*found].time;
}

autopilot::Health EventDetector::settled(autopilot::Health health, double time) {
  constexpr double kCalm = 0.5;  // s
  const bool better = health != autopilot::Health::kUninitialised &&
                      seen_.health != autopilot::Health::kUninitialised && health < seen_.health;
  if (better && !betters_) better_since_ = time;
  betters_ = better;
  if (!better) return health;
  if (time - better_since_ < kCalm) return seen_.health;
  betters_ = false;
  return health;
}

void EventDetector::report(const Seen& fresh, double time, Timeline& timeline) {
  if (fresh.armed != seen_.armed) timeline.add(time, "arming", fresh.armed ? "armed" : "unarmed");
  if (fresh.phase != seen_.phase) {
    if (fresh.cause != autopilot::PhaseCause::kPlanned) timeline.add(time, "cause", name_of(fresh.cause));
    timeline.add(time, "phase", name_of(fresh.phase));
  }
  if (fresh.health != seen_.health) timeline.add(time, "health", name_of(fresh.health));
  if (fresh.doubtful != seen_.doubtful) timeline.add(time, "position", fresh.doubtful ? "doubtful" : "sure");
  if (const double jump = (fresh.position_reset_sum_N - seen_.position_reset_sum_N).norm(); jump > 0.0) {
    timeline.add(time, "position_reset", with_unit(jump, "m"));
  }
  seen_ = fresh;
}

void EventDetector::look_at_route(double time, Timeline& timeline) {
  const autopilot::TrajectoryPoint& point = signals_.trajectory;
  if (!point.valid) return;
  const bool begins_anew = point.reached < reached_;
  if (begins_anew) of_routes_before_ += std::exchange(reached_, 0);
  while (reached_ < point.reached) {
    ++reached_;
    timeline.add(time, "waypoint", "waypoint_" + std::to_string(of_routes_before_ + reached_));
  }
  if (!point.finished) return;
  const Finish finish{of_routes_before_ + reached_, signals_.route.revision};
  if (finish != finish_) timeline.add(time, "waypoint", "route_finished");
  finish_ = finish;
}

void EventDetector::look_at_places(double time, Timeline& timeline) {
  const autopilot::StateEstimate& x = signals_.estimate;
  if (x.position_offset_N != offset_N_ && x.position_doubtful) {
    timeline.add(time, "fixes_disagree", with_unit((x.position_offset_N - offset_N_).norm(), "m"));
  }
  offset_N_ = x.position_offset_N;
  const bool same_place = x.origin.latitude == origin_.latitude && x.origin.longitude == origin_.longitude;
  if (same_place && x.origin.known == origin_.known) return;
  const auto moved_N = autopilot::local_from_geodetic(x.origin.latitude, x.origin.longitude, origin_);
  if (origin_.known && x.origin.known) timeline.add(time, "origin_moved", with_unit(moved_N.norm(), "m"));
  origin_ = x.origin;
}

}  // namespace ironbird::scenarios
