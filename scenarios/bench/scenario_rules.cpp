#include "scenarios/bench/scenario_rules.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "scenarios/config/nearest_name.hpp"
#include "simulator/fault/fault_state.hpp"

namespace ironbird::scenarios {

namespace {

template <class Enum>
std::string name_of_value(Enum value) {
  for (const auto& [enumerator, name] : enumerators(value)) {
    if (enumerator == value) return std::string(name);
  }
  return "?";
}

int deeds_of(const EventConfig& event) {
  return static_cast<int>(event.fault.has_value()) + static_cast<int>(event.pilot.has_value()) +
         static_cast<int>(event.request.has_value()) + static_cast<int>(event.add_waypoint.has_value()) +
         static_cast<int>(event.remove_waypoint.has_value()) + static_cast<int>(event.setpoint.has_value()) +
         static_cast<int>(!event.swap.empty()) + static_cast<int>(!event.set.empty());
}

class Rules {
 public:
  explicit Rules(const LoadedScenario& loaded) : loaded_(loaded) {}

  std::vector<std::string> findings() {
    check_field();
    check_waypoints();
    check_events();
    check_cameras();
    check_snapshots();
    check_faults();
    return findings_;
  }

 private:
  void check_field() {
    const std::filesystem::path field = loaded_.project_root / loaded_.scenario.field;
    if (!loaded_.scenario.field.empty() && !std::filesystem::exists(field)) {
      report("field = \"" + loaded_.scenario.field +
             "\": there is no such file; fields are in models/fields");
    }
  }

  void check_waypoints() {
    const auto& waypoints = loaded_.scenario.waypoints;
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const std::string path = "waypoint[" + std::to_string(i) + "]";
      if (!waypoints[i].p_N.allFinite()) report(path + ".p_N: every number must be finite");
      if (!std::isfinite(waypoints[i].heading)) report(path + ".heading: must be finite");
    }
    if (waypoints.empty() && loaded_.scenario.pilot.automatic && !events_fly()) {
      report(
          "waypoint: there is none, and no event flies anything; add a [[waypoint]], or an [[event]] with "
          "add_waypoint, setpoint, request or pilot");
    }
    if (loaded_.scenario.cyclic && waypoints.size() < 2) {
      report("cyclic = true: a round needs at least two waypoints, found " +
             std::to_string(waypoints.size()));
    }
  }

  bool events_fly() const {
    const auto& events = loaded_.scenario.events;
    return std::any_of(events.begin(), events.end(), [](const EventConfig& event) {
      return event.add_waypoint || event.setpoint || event.request || event.pilot;
    });
  }

  void check_events() {
    const auto& events = loaded_.scenario.events;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const std::string path = "event[" + std::to_string(i) + "]";
      const EventConfig& event = events[i];
      if (deeds_of(event) != 1) {
        report(path + ": does " + std::to_string(deeds_of(event)) +
               " things, must do exactly one of fault, pilot, request, add_waypoint, remove_waypoint, "
               "setpoint, swap, set");
      }
      if (!event.swap.empty() && event.kind.empty())
        report(path + ".swap: needs the kind of the new module in `kind`");
      if (event.setpoint) check_setpoint(path, *event.setpoint);
    }
  }

  void check_setpoint(const std::string& path, const SetpointConfig& setpoint) {
    try {
      only_setpoint(setpoint);
    } catch (const std::invalid_argument& error) {
      report(path + ".setpoint: " + error.what());
    }
  }

  void check_cameras() {
    std::vector<std::string> names = {"chase", "top"};
    for (const CameraConfig& camera : loaded_.scenario.cameras) names.push_back(camera.name);
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

  void check_faults() {
    const int rotors = static_cast<int>(loaded_.scenario.vehicle.rotors.size());
    const auto& events = loaded_.scenario.events;
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (!events[i].fault) continue;
      try {
        simulator::check(fault_of(events[i]), rotors);
      } catch (const std::invalid_argument& error) {
        report("event[" + std::to_string(i) + "]: " + error.what());
      }
    }
  }

  void report(const std::string& finding) {
    findings_.push_back(loaded_.located(std::invalid_argument(finding)).what());
  }

  const LoadedScenario& loaded_;
  std::vector<std::string> findings_;
};

}  // namespace

void check_rules(const LoadedScenario& loaded) {
  std::vector<std::string> findings = Rules(loaded).findings();
  if (!findings.empty()) throw ConfigError(std::move(findings));
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
  if (event.pilot) return name_of_value(*event.pilot);
  if (event.request) return name_of_value(*event.request);
  if (event.add_waypoint) return "add_waypoint";
  if (event.remove_waypoint) return "remove_waypoint";
  if (event.setpoint) return "setpoint";
  if (!event.swap.empty()) return event.swap + " " + event.kind;
  return event.set;
}

}  // namespace ironbird::scenarios
