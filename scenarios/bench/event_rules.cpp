#include "scenarios/bench/event_rules.hpp"

#include <algorithm>

#include "scenarios/bench/event_names.hpp"
#include "scenarios/bench/scenario_rules.hpp"
#include "simulator/fault/fault_state.hpp"

namespace ironbird::scenarios {

namespace {

using simulator::FaultKind;

/// The keys that say what happens; an event has exactly one of them.
constexpr const char* kDeeds[] = {"fault",    "pilot", "request", "add_waypoint", "remove_waypoint",
                                  "setpoint", "swap",  "set",     "link",         "bus"};

/// A key that only some deeds take, and which do.
struct Detail {
  const char* key;
  const char* belongs_to;
};
constexpr Detail kDetails[] = {
    {"lasts", "a fault other than battery_charge, link and bus"},
    {"index", "rotor_efficiency, rotor_loss and add_waypoint"},
    {"magnitude",
     "rotor_efficiency, baro_bias, battery_charge, payload, link, bus, request = \"hold\" and pilot = "
     "\"move_throttle\""},
    {"vector", "accelerometer_bias, gyro_bias, mag_bias, gnss_jump and wind"},
    {"kind", "swap"},
    {"value", "set"}};

/// What an event of some deed may say beside name, at and after.
struct Keys {
  std::vector<std::string> needed;
  std::vector<std::string> allowed;
};

Keys keys_of(FaultKind fault) {
  switch (fault) {
    case FaultKind::kRotorEfficiency:
      return {{"magnitude"}, {"lasts", "index"}};
    case FaultKind::kRotorLoss:
      return {{}, {"lasts", "index"}};
    case FaultKind::kBaroBias:
    case FaultKind::kPayload:
      return {{"magnitude"}, {"lasts"}};
    case FaultKind::kBatteryCharge:
      return {{"magnitude"}, {}};
    case FaultKind::kAccelerometerBias:
    case FaultKind::kGyroBias:
    case FaultKind::kMagBias:
    case FaultKind::kGnssJump:
    case FaultKind::kWind:
      return {{"vector"}, {"lasts"}};
    default:
      return {{}, {"lasts"}};
  }
}

Keys keys_of(const EventConfig& event) {
  if (event.fault) return keys_of(*event.fault);
  if (event.link || event.bus) {
    if (needs_end(event.link ? *event.link : *event.bus)) return {{"lasts"}, {}};
    return {{"magnitude"}, {"lasts"}};
  }
  if (event.pilot == PilotAction::kMoveThrottle) return {{"magnitude"}, {}};
  if (event.request == OperatorWish::kHold) return {{}, {"magnitude"}};
  if (event.add_waypoint) return {{}, {"index"}};
  if (!event.swap.empty()) return {{"kind"}, {}};
  if (!event.set.empty()) return {{"value"}, {}};
  return {};
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class EventRules {
 public:
  explicit EventRules(const LoadedScenario& loaded)
      : loaded_(loaded),
        scenario_(loaded.scenario),
        names_(loaded.scenario),
        longest_(longest_route(loaded.scenario)) {}

  std::vector<std::string> findings() {
    for (std::size_t i = 0; i < scenario_.events.size(); ++i) {
      const std::string path = "event[" + std::to_string(i) + "]";
      check_moment(path + ".after", scenario_.events[i].after);
      check_name(path, i);
      if (check_deed(path)) check_details(path, scenario_.events[i]);
    }
    for (std::size_t i = 0; i < scenario_.snapshots.size(); ++i)
      check_moment("snapshot[" + std::to_string(i) + "].after", scenario_.snapshots[i].after);
    check_moment("end_after", scenario_.end_after);
    return std::move(findings_);
  }

 private:
  /// What waits for it would not know for which.
  void check_name(const std::string& path, std::size_t index) {
    const std::string& name = scenario_.events[index].name;
    if (const std::string why = names_.objection(name); !why.empty())
      findings_.push_back(path + ".name = \"" + name + "\": " + why);
    for (std::size_t i = 0; i < index; ++i) {
      if (name.empty() || scenario_.events[i].name != name) continue;
      findings_.push_back(path + ".name = \"" + name + "\": event[" + std::to_string(i) +
                          "] has this name too; must be another");
    }
  }

  void check_moment(const std::string& path, const std::string& event) {
    if (event.empty()) return;
    const std::string wrong = names_.complaint(event, EventNames::Waiting::kDeed);
    if (!wrong.empty()) findings_.push_back(path + " = \"" + event + "\": " + wrong);
  }

  bool check_deed(const std::string& path) {
    std::string found, all;
    int count = 0;
    for (const char* deed : kDeeds) {
      all += (all.empty() ? "" : ", ") + std::string(deed);
      if (!loaded_.gives(path + "." + deed)) continue;
      found += (found.empty() ? "" : ", ") + std::string(deed);
      ++count;
    }
    if (count == 1) return true;
    findings_.push_back(path + ": does " + (count == 0 ? "nothing" : "several things, " + found) +
                        "; must do exactly one of " + all);
    return false;
  }

  void check_details(const std::string& path, const EventConfig& event) {
    const Keys keys = keys_of(event);
    for (const Detail& detail : kDetails) {
      if (!loaded_.gives(path + "." + detail.key) || contains(keys.needed, detail.key) ||
          contains(keys.allowed, detail.key)) {
        continue;
      }
      findings_.push_back(path + "." + detail.key + ": has no meaning in this event; it belongs to " +
                          detail.belongs_to);
    }
    for (const std::string& key : keys.needed) {
      if (!loaded_.gives(path + "." + key)) findings_.push_back(path + ": needs the key `" + key + "`");
    }
    if (event.setpoint) check_setpoint(path, *event.setpoint);
    if (event.fault) check_fault(path, event);
    if (event.link || event.bus) check_link(path, event);
    check_amount(path, event);
    check_index(path, event);
  }

  void check_setpoint(const std::string& path, const SetpointConfig& setpoint) {
    try {
      only_setpoint(setpoint);
    } catch (const std::invalid_argument& error) {
      findings_.push_back(path + ".setpoint: " + error.what());
    }
  }

  void check_fault(const std::string& path, const EventConfig& event) {
    try {
      simulator::check(fault_of(event), static_cast<int>(scenario_.vehicle.rotors.size()));
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      const bool of_index = text.find("index") != std::string::npos;
      findings_.push_back(path + (of_index ? ".index: " : ".magnitude: ") + text);
    }
  }

  void check_link(const std::string& path, const EventConfig& event) {
    const FcuConfig& fcu = scenario_.fcu;
    if (fcu.kind == FcuKind::kSerial) {
      findings_.push_back(path + ": the line to a real vehicle is not made to fail; leave the event away");
    }
    if (event.link && fcu.kind == FcuKind::kVirtual) {
      findings_.push_back(path +
                          ".link: there is no line that could fail; reach the unit over one: fcu.kind = "
                          "\"virtual_serial\" or \"hil\"");
    }
    if (event.bus && fcu.kind != FcuKind::kSerial &&
        (fcu.kind != FcuKind::kHil || fcu.motors == kOutputRaw)) {
      findings_.push_back(path +
                          ".bus: there is no bus that could fail; put the motors on one: fcu.kind = "
                          "\"hil\", fcu.motors = \"can\"");
    }
    const LinkFaultKind kind = event.link ? *event.link : *event.bus;
    const std::string_view wrong = complaint_about(kind, event.magnitude);
    if (!wrong.empty()) findings_.push_back(path + ".magnitude: of this fault, " + std::string(wrong));
    if (needs_end(kind) && loaded_.gives(path + ".lasts") && event.lasts <= 0.0)
      findings_.push_back(path + ".lasts: must be above 0 s");
  }

  void check_amount(const std::string& path, const EventConfig& event) {
    if (event.pilot == PilotAction::kMoveThrottle && (event.magnitude < 0.0 || event.magnitude > 1.0))
      findings_.push_back(path + ".magnitude: of the throttle stick, must be between 0 and 1");
    if (event.request == OperatorWish::kHold && event.magnitude < 0.0)
      findings_.push_back(path + ".magnitude: of a hold, must be >= 0 s; 0: until released");
  }

  void check_index(const std::string& path, const EventConfig& event) {
    const std::string count = std::to_string(longest_);
    if (event.remove_waypoint && static_cast<std::size_t>(*event.remove_waypoint) >= longest_) {
      findings_.push_back(path + ".remove_waypoint = " + std::to_string(*event.remove_waypoint) +
                          ": must be below " + count +
                          ", the most waypoints that the route has; they count from 0");
    }
    if (event.add_waypoint && event.index && static_cast<std::size_t>(*event.index) >= longest_) {
      findings_.push_back(path + ".index = " + std::to_string(*event.index) + ": must be below " + count +
                          ", the most waypoints that the route has; they count from 0");
    }
  }

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  const EventNames names_;
  const std::size_t longest_;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> event_findings(const LoadedScenario& loaded) {
  return EventRules(loaded).findings();
}

}  // namespace ironbird::scenarios
