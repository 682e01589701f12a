#include "scenarios/bench/scenario_rules.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "autopilot/math/local_map.hpp"
#include "scenarios/bench/check_rules.hpp"
#include "scenarios/bench/event_names.hpp"
#include "scenarios/bench/event_rules.hpp"
#include "scenarios/bench/hil_rules.hpp"
#include "scenarios/bench/live_rules.hpp"
#include "scenarios/bench/model_files.hpp"
#include "scenarios/bench/tick_rules.hpp"
#include "scenarios/config/nearest_name.hpp"

namespace ironbird::scenarios {

namespace {

template <class Enum>
std::string name_of_value(Enum value) {
  for (const auto& [enumerator, name] : enumerators(value)) {
    if (enumerator == value) return std::string(name);
  }
  return "?";
}

/// More of anything was hardly meant, and would take minutes to hold against each other.
constexpr std::size_t kMostTables = 1000;

class Rules {
 public:
  explicit Rules(const LoadedScenario& loaded) : loaded_(loaded) {}

  std::vector<std::string> findings() {
    check_counts();
    if (!findings_.empty()) return findings_;
    check_field();
    check_start();
    check_waypoints();
    report_all(tick_findings(loaded_));
    report_all(whole_tick_findings(loaded_));
    report_all(hil_findings(loaded_));
    check_cameras();
    check_snapshots();
    report_all(event_findings(loaded_));
    report_all(check_findings(loaded_));
    if (loaded_.scenario.fcu.kind == FcuKind::kSerial) report_all(live_findings(loaded_));
    return findings_;
  }

 private:
  void check_counts() {
    const Scenario& scenario = loaded_.scenario;
    const std::pair<const char*, std::size_t> counts[] = {{"event", scenario.events.size()},
                                                          {"check", scenario.checks.size()},
                                                          {"camera", scenario.cameras.size()},
                                                          {"cut", scenario.cuts.size()},
                                                          {"snapshot", scenario.snapshots.size()}};
    for (const auto& [name, count] : counts) {
      if (count > kMostTables)
        report(std::string(name) + ": there are " + std::to_string(count) + ", must be at most " +
               std::to_string(kMostTables));
    }
    const std::size_t longest = longest_route(scenario);
    if (longest > autopilot::kMostWaypoints) {
      report("waypoint: the route would have " + std::to_string(longest) + " waypoints, must have at most " +
             std::to_string(autopilot::kMostWaypoints));
    }
  }

  void check_field() {
    // The default matters only to pictures, and is missed when they are to be made.
    if (loaded_.gives("field") && !loaded_.scenario.field.empty() && loaded_.field_path.empty()) {
      report("field = \"" + loaded_.scenario.field + "\": there is no such file in " +
             loaded_.field_folders.front().string() + ", in a folder above it or in Ironbird's tree; " +
             fields_in(loaded_.field_folders));
    }
  }

  void check_start() {
    const StartConfig& start = loaded_.scenario.start;
    if (!start.on_ground && start.p_N[2] > 0.0) report("start.p_N[2]: lies below the ground, must be <= 0 m");
  }

  void check_waypoints() {
    const auto& waypoints = loaded_.scenario.waypoints;
    const auto& events = loaded_.scenario.events;
    for (std::size_t i = 0; i < waypoints.size(); ++i)
      check_waypoint("waypoint[" + std::to_string(i) + "]", waypoints[i]);
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (events[i].add_waypoint)
        check_waypoint("event[" + std::to_string(i) + "].add_waypoint", *events[i].add_waypoint);
    }
    if (waypoints.empty() && loaded_.scenario.pilot.automatic && !events_fly()) {
      report(
          "waypoint: there is none, and no event flies anything; add a [[waypoint]], or an [[event]] with "
          "add_waypoint, setpoint, request or pilot");
    }
    if (loaded_.scenario.cyclic && longest_mission(loaded_.scenario) < 2) {
      report("cyclic = true: a round needs at least two waypoints, found " +
             std::to_string(waypoints.size()));
    }
  }

  void check_waypoint(const std::string& path, const autopilot::Waypoint& waypoint) {
    const bool local = loaded_.gives(path + ".p_N");
    if (local == waypoint.geodetic.has_value()) {
      report(path + ": needs either p_N or geodetic, has " + (local ? "both" : "neither"));
    } else if (waypoint.geodetic) {
      check_geodetic(path + ".geodetic", *waypoint.geodetic);
    } else if (waypoint.p_N.z() > 0.0) {
      report(path + ".p_N[2]: lies below the ground; down is positive, must be <= 0 m");
    }
    if (loaded_.gives(path + ".id")) report(path + ".id: is given by the planner, leave it away");
  }

  void check_geodetic(const std::string& path, const autopilot::GeodeticPosition& place) {
    for (const char* key : {"latitude", "longitude", "altitude"}) {
      if (!loaded_.gives(path + "." + key)) return report(path + ": needs the key `" + key + "`");
    }
    const simulator::HomeParams& home = loaded_.scenario.environment.home;
    const autopilot::Vector3 p_N =
        autopilot::local_from_geodetic(place, {true, home.latitude, home.longitude, home.altitude});
    const double distance = std::max(std::abs(p_N.x()), std::abs(p_N.y()));
    const auto whole = [](double number) { return std::to_string(std::llround(number)); };
    if (distance > autopilot::kFarthestWaypoint) {
      report(path + ": lies " + whole(distance / 1e3) + " km from environment.home, must be within " +
             whole(autopilot::kFarthestWaypoint / 1e3) + " km");
    } else if (p_N.z() > 0.0) {
      report(path + ".altitude: lies below the ground, must be >= " + whole(home.altitude) +
             " m, the altitude of environment.home");
    }
  }

  bool events_fly() const {
    const auto& events = loaded_.scenario.events;
    return std::any_of(events.begin(), events.end(), [](const EventConfig& event) {
      return event.add_waypoint || event.setpoint || event.request || event.pilot;
    });
  }

  void check_cameras() {
    std::vector<std::string> names = {"chase", "top"};
    for (std::size_t i = 0; i < loaded_.scenario.cameras.size(); ++i) {
      const CameraConfig& camera = loaded_.scenario.cameras[i];
      const std::string path = "camera[" + std::to_string(i) + "]";
      if (std::find(names.begin(), names.end(), camera.name) != names.end())
        report(path + ".name = \"" + camera.name + "\": is taken by another camera");
      if (camera.target_N == camera.p_N)
        report(path + ".target_N: must differ from p_N, or it looks nowhere");
      names.push_back(camera.name);
    }
    const auto check = [&](const std::string& path, const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        const std::string nearest = nearest_name(name, names);
        report(path + ".camera = \"" + name + "\": there is no such camera; did you mean \"" +
               (nearest.empty() ? "chase" : nearest) + "\"?");
      }
    };
    for (std::size_t i = 0; i < loaded_.scenario.snapshots.size(); ++i) {
      check("snapshot[" + std::to_string(i) + "]", loaded_.scenario.snapshots[i].camera);
    }
    for (std::size_t i = 0; i < loaded_.scenario.cuts.size(); ++i) {
      check("cut[" + std::to_string(i) + "]", loaded_.scenario.cuts[i].camera);
    }
  }

  void check_snapshots() {
    std::vector<std::string> seen;
    const auto& snapshots = loaded_.scenario.snapshots;
    for (std::size_t i = 0; i < snapshots.size(); ++i) {
      const std::string& name = snapshots[i].name;
      const std::string path = "snapshot[" + std::to_string(i) + "].name = \"" + name + "\"";
      const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
      });
      if (!plain) report(path + ": becomes a file name: letters, digits, _ and - only");
      if (std::find(seen.begin(), seen.end(), name) != seen.end())
        report(path + ": is taken by another snapshot");
      seen.push_back(name);
    }
  }

  void report_all(const std::vector<std::string>& findings) {
    for (const std::string& finding : findings) report(finding);
  }

  void report(const std::string& finding) { findings_.push_back(loaded_.located(finding)); }

  const LoadedScenario& loaded_;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> rule_findings(const LoadedScenario& loaded) {
  return Rules(loaded).findings();
}

autopilot::ControlSetpoint only_setpoint(const SetpointConfig& config) {
  std::vector<autopilot::ControlSetpoint> given;
  SetpointConfig::describe(config, [&](const char*, const auto& entry, const char*, const char*) {
    if (entry) given.emplace_back(*entry);
  });
  if (given.size() != 1) {
    throw std::invalid_argument("gives " + std::to_string(given.size()) +
                                " entry points, must give exactly one");
  }
  return given.front();
}

simulator::Fault fault_of(const EventConfig& event) {
  return {*event.fault,
          event.index.value_or(0),
          event.magnitude,
          {event.vector[0], event.vector[1], event.vector[2]}};
}

std::string picture_event(const std::string& snapshot) {
  return "picture " + snapshot;
}

std::string describe_event(const EventConfig& event) {
  if (!event.name.empty()) return event.name;
  if (event.fault) return name_of_value(*event.fault);
  if (event.link) return "link_" + name_of_value(*event.link);
  if (event.bus) return "bus_" + name_of_value(*event.bus);
  if (event.pilot) return name_of_value(*event.pilot);
  if (event.request) return name_of_value(*event.request);
  if (event.add_waypoint) return "add_waypoint";
  if (event.remove_waypoint) return "remove_waypoint";
  if (event.setpoint) return "setpoint";
  if (!event.swap.empty()) return event.swap + " " + event.kind;
  return event.set;
}

}  // namespace ironbird::scenarios
