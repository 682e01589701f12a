#include "scenarios/requirements/timeline.hpp"

namespace ironbird::scenarios {

namespace {

template <class Enum>
std::string name_of(Enum value) {
  for (const auto& [candidate, name] : enumerators(value)) {
    if (candidate == value) return std::string(name);
  }
  return std::to_string(static_cast<int>(value));
}

bool is_called(const RunEvent& event, std::string_view name) {
  if (name == event.text || name == event.kind) return true;
  return name.size() == event.kind.size() + 1 + event.text.size() && name.starts_with(event.kind) &&
         name[event.kind.size()] == ':' && name.ends_with(event.text);
}

}  // namespace

std::optional<double> Timeline::first(std::string_view name, double from) const {
  for (const RunEvent& event : events_) {
    if (event.time >= from && is_called(event, name)) return event.time;
  }
  return std::nullopt;
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
  const std::uint32_t counted_from = fresh.reached < seen_.reached ? 0 : seen_.reached;
  for (std::uint32_t i = counted_from + 1; i <= fresh.reached; ++i) {
    timeline.add(time, "waypoint", "waypoint_" + std::to_string(i));
  }
  if (fresh.finished && !seen_.finished) timeline.add(time, "waypoint", "route_finished");
  seen_ = fresh;
}

}  // namespace ironbird::scenarios
