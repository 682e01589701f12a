#include "scenarios/bench/expected_end.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "autopilot/controller/cascaded_controller.hpp"
#include "autopilot/math/angles.hpp"
#include "autopilot/math/local_map.hpp"
#include "autopilot/path_manager/motion.hpp"
#include "autopilot/path_planner/waypoint_planner.hpp"
#include "scenarios/bench/scenario_rules.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Vector3;
using Instant = std::optional<double>;  // s; nothing: cannot be told

constexpr double kSpinUp = 0.5;          // s, from the request to the first movement
constexpr double kLargestShare = 0.95;   // of a run that is not over
constexpr std::size_t kMostLegs = 1000;  // of a route that goes on for ever

/// The earlier of two moments that can be told.
Instant earlier(Instant a, Instant b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

Instant later_by(Instant moment, double delay) {
  return moment ? Instant(*moment + delay) : moment;
}

class Forecast {
 public:
  explicit Forecast(const LoadedScenario& loaded) : loaded_(loaded), scenario_(loaded.scenario) {
    take_limits();
    take_off_ = first_wish(OperatorWish::kTakeOff);
    if (scenario_.pilot.automatic) take_off_ = scenario_.pilot.take_off_at;
    add_route();
    known_.clear();  // what was asked for meanwhile knew neither
  }

  Instant when(const std::string& event) {
    const std::string name = event.substr(event.find(':') + 1);
    // Found once each: many events may wait for one. One that waits for itself finds nothing.
    const auto [known, is_new] = known_.try_emplace(name);
    if (!is_new) return known->second;
    const Instant moment = look(name);
    return known_[name] = moment;
  }

 private:
  struct Stop {
    double time;
    Vector3 p_N;
    double heading;
  };

  void take_limits() {
    const auto take = [&](const std::string& slot, const std::string& kind, auto& params) {
      const ModuleSettings* settings = loaded_.settings_of(slot, kind);
      if (settings == nullptr) return;
      params.describe(params, [&]<class Value>(const char* name, Value& value, const auto&...) {
        for (const auto& [path, setting] : settings->values) {
          const auto* const set = std::get_if<double>(&setting);
          if constexpr (std::is_same_v<Value, double>) {
            if (set != nullptr && path == slot + "." + name) value = *set;
          }
        }
      });
    };
    take("path_manager", loaded_.autopilot.path_manager.kind, limits_);
    take("controller", loaded_.autopilot.controller.kind, controller_);
    take("path_planner", loaded_.autopilot.path_planner.kind, planner_);
  }

  /// The end of a leg from rest to rest.
  Stop after(const Stop& from, const Vector3& p_N, double heading, double speed) const {
    const double turn = std::abs(autopilot::shortest_difference(heading, from.heading));
    const double length = (p_N - from.p_N).norm();
    const double most = speed > 0.0 ? speed : limits_.max_velocity;
    return {from.time + autopilot::leg_duration(length, turn, most, limits_), p_N, heading};
  }

  Vector3 place_of(const autopilot::Waypoint& waypoint) const {
    const simulator::HomeParams& home = scenario_.environment.home;
    if (!waypoint.geodetic) return waypoint.p_N;
    return autopilot::local_from_geodetic(*waypoint.geodetic,
                                          {true, home.latitude, home.longitude, home.altitude});
  }

  Instant hold() const {
    const double climb = controller_.take_off_height - controller_.take_off_height_threshold;
    return later_by(take_off_, kSpinUp + climb / controller_.take_off_speed);
  }

  Instant offboard() const { return later_by(hold(), controller_.take_off_hold_time); }

  void add_route() {
    const auto& waypoints = scenario_.waypoints;
    if (waypoints.empty() || !take_off_) return;
    const auto& start = scenario_.start.p_N;
    Stop at{*offboard(), {start[0], start[1], -controller_.take_off_height}, scenario_.start.heading};
    stops_.push_back(at);
    for (std::size_t i = 0; i < (scenario_.cyclic ? kMostLegs : waypoints.size()); ++i) {
      const autopilot::Waypoint& waypoint = waypoints[i % waypoints.size()];
      at = after(at, place_of(waypoint), waypoint.heading, waypoint.speed);
      stops_.push_back(at);
      if (waypoint.kind == autopilot::WaypointKind::kLand) {
        lands_ = true;
        return;
      }
      if (waypoint.kind == autopilot::WaypointKind::kHold) at.time += waypoint.hold_time;
    }
  }

  /// The first of the scenario's events for which `is_meant` holds.
  template <class IsMeant>
  Instant first_event(IsMeant is_meant) {
    Instant first;
    for (const EventConfig& event : scenario_.events) {
      if (!is_meant(event)) continue;
      first = earlier(first, later_by(event.after.empty() ? Instant(0.0) : when(event.after), event.at));
    }
    return first;
  }

  Instant first_wish(OperatorWish wish) {
    return first_event([wish](const EventConfig& event) { return event.request == wish; });
  }

  /// Where the vehicle is at `time`, as far as the route says.
  Stop stop_before(double time) const {
    Stop last{time, {0.0, 0.0, -controller_.take_off_height}, 0.0};
    for (const Stop& stop : stops_) {
      if (stop.time <= time) last = {time, stop.p_N, stop.heading};
    }
    return last;
  }

  /// When the descent begins, and above which place.
  std::optional<Stop> landing() {
    std::optional<Stop> first;
    const auto consider = [&](const Stop& stop) {
      if (!first || stop.time < first->time) first = stop;
    };
    if (lands_) consider(stops_.back());
    if (const Instant asked = first_wish(OperatorWish::kLand)) consider(stop_before(*asked));
    if (const Instant asked = first_wish(OperatorWish::kReturnToLaunch)) {
      const Stop from = stop_before(*asked);
      const double height = std::max(planner_.return_height, -from.p_N.z());
      const Stop above = after(from, {from.p_N.x(), from.p_N.y(), -height}, from.heading, 0.0);
      consider(after(above, {scenario_.start.p_N[0], scenario_.start.p_N[1], -height}, 0.0, 0.0));
    }
    return first;
  }

  Instant landed() {
    const std::optional<Stop> begin = landing();
    if (!begin) return std::nullopt;
    const double height = std::max(0.0, -begin->p_N.z());
    const double slow = std::min(height, controller_.landing_slow_height);
    return begin->time + (height - slow) / controller_.descent_speed + slow / controller_.landing_speed;
  }

  Instant look(const std::string& name) {
    const auto is_named = [&](const EventConfig& event) { return describe_event(event) == name; };
    if (const Instant own = first_event(is_named)) return own;
    if (name == "armed") return scenario_.pilot.automatic ? Instant(scenario_.pilot.arm_at) : std::nullopt;
    if (name == "take_off") return take_off_;
    if (name == "hold") return hold();
    if (name == "offboard") return stops_.empty() ? std::nullopt : offboard();
    if (name == "landing") return landing() ? Instant(landing()->time) : std::nullopt;
    if (name == "landed") return landed();
    if (name == "unarmed" || name == "disarmed") return later_by(landed(), PilotConfig::kDisarmDelay);
    for (std::size_t i = 1; i < stops_.size(); ++i) {
      const bool last = !scenario_.cyclic && i + 1 == stops_.size();
      if (name == "waypoint_" + std::to_string(i) || (last && name == "route_finished"))
        return stops_[i].time;
    }
    return std::nullopt;
  }

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  autopilot::MotionLimits limits_;
  autopilot::CascadedControllerParams controller_;
  autopilot::WaypointPlannerParams planner_;
  Instant take_off_;
  std::vector<Stop> stops_;  // where the route begins, and its waypoints
  bool lands_ = false;
  std::map<std::string, Instant> known_;
};

}  // namespace

double expected_end(const LoadedScenario& loaded) {
  const Scenario& scenario = loaded.scenario;
  if (scenario.end_after.empty()) return scenario.duration;
  const Instant end = later_by(Forecast(loaded).when(scenario.end_after), scenario.end_delay);
  return end && std::isfinite(*end) ? std::min(*end, scenario.duration) : scenario.duration;
}

double shown_end(double expected, double now, double duration) {
  return std::min(std::max(expected, now / kLargestShare), duration);
}

}  // namespace ironbird::scenarios
