#include "scenarios/bench/hil_rules.hpp"

#include <algorithm>

namespace ironbird::scenarios {

namespace {

const std::string kRemedy = "; reach the unit over a line: fcu.kind = \"virtual_serial\" or \"hil\"";

constexpr double kSlowestStand = 0.1;  // limits on commands count the run's time

class HilRules {
 public:
  explicit HilRules(const LoadedScenario& loaded) : loaded_(loaded), fcu_(loaded.scenario.fcu) {}

  std::vector<std::string> findings() {
    if (fcu_.kind == FcuKind::kVirtual && loaded_.gives("fcu.link_fault"))
      report("fcu.link_fault: there is no line that could fail" + kRemedy);
    if (fcu_.kind == FcuKind::kSerial && loaded_.gives("fcu.link_fault"))
      report("fcu.link_fault: the line to a real vehicle is not made to fail; leave it away" + kRemedy);
    if (fcu_.kind != FcuKind::kHil) {
      for (const char* key : {"motors", "stand", "can_fd", "external_attitude", "bus_fault", "time_scale"}) {
        const std::string path = std::string("fcu.") + key;
        if (loaded_.gives(path)) report(path + ": has no meaning here; it belongs to fcu.kind = \"hil\"");
      }
      return findings_;
    }
    check_motors();
    if (loaded_.gives("fcu.stand")) check_stand();
    if (fcu_.has_own_unit() && loaded_.gives("fcu.time_scale"))
      report("fcu.time_scale: a unit in this process knows no clock; it belongs to one at the end of a line");
    if (fcu_.motors == kOutputRaw && loaded_.gives("fcu.bus_fault"))
      report("fcu.bus_fault: there is no bus that could fail; put the motors on one: fcu.motors = \"can\"");
    return findings_;
  }

 private:
  void check_motors() {
    const std::string& motors = fcu_.motors;
    if (motors == kOutputRaw) return;
    const std::string shown = "fcu.motors = \"" + motors + "\": ";
    const bool interface = names_interface(motors);
    if (motors != kOwnBus && !interface) return report(shown + "must be output_raw, can, or can:INTERFACE");
    if (interface && fcu_.has_own_unit()) {
      report(shown + "a unit in this process has its motors on a bus in this process; write \"can\"");
    } else if (!interface && !fcu_.has_own_unit()) {
      report(shown + "say on which interface of this machine they are, as \"can:can0\"");
    }
  }

  void check_stand() {
    const std::string shown = "fcu.stand = \"" + fcu_.stand + "\": ";
    if (!names_interface(fcu_.stand)) {
      report(shown +
             "must say on which interface of this machine the motor controllers are, as \"can:can0\"");
    } else if (fcu_.has_own_unit()) {
      report(shown +
             "a unit in this process flies faster than real motors turn; it belongs to one at the end of a "
             "line");
    } else if (fcu_.motors != kOutputRaw) {
      report(shown +
             "a unit with motors on a bus commands them itself; it belongs to fcu.motors = \"output_raw\"");
    } else if (fcu_.time_scale < kSlowestStand) {
      report("fcu.time_scale: real motors know the clock only; with fcu.stand it must be at least 0.1");
    }
  }

  static bool names_interface(const std::string& text) {
    return text.starts_with(kCanInterface) && text.size() > kCanInterface.size();
  }

  void report(const std::string& finding) { findings_.push_back(finding); }

  const LoadedScenario& loaded_;
  const FcuConfig& fcu_;
  std::vector<std::string> findings_;
};

bool closes_the_units_loops(const SetpointConfig& setpoint) {
  return setpoint.angle_heading_throttle || setpoint.angle_heading_rate_throttle || setpoint.rate_throttle;
}

/// Where the scenario asks for angles or rates instead of torques; empty: nowhere.
std::string first_unit_loop(const LoadedScenario& loaded) {
  for (const ModuleSettings& module : loaded.modules) {
    for (const autopilot::ParameterSetting& setting : module.values) {
      const auto* output = std::get_if<int>(&setting.second);
      if (setting.first == "controller.acceleration_output" && output != nullptr && *output == 0)
        return "autopilot.controller.acceleration_output";
    }
  }
  const auto& events = loaded.scenario.events;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].setpoint && closes_the_units_loops(*events[i].setpoint))
      return "event[" + std::to_string(i) + "].setpoint";
  }
  return "";
}

}  // namespace

std::vector<std::string> hil_findings(const LoadedScenario& loaded) {
  return HilRules(loaded).findings();
}

std::vector<std::string> loop_findings(const LoadedScenario& loaded) {
  if (loaded.scenario.fcu.kind != FcuKind::kHil) return {};
  const std::string where = first_unit_loop(loaded);
  if (where.empty()) return {};
  return {loaded.located(
      where +
      ": asks the unit for angles or rates, and a unit on a desk feels no motion, even when it "
      "is told the attitude; command torques and thrust")};
}

}  // namespace ironbird::scenarios
