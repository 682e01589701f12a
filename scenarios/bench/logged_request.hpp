#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "autopilot/request.hpp"

namespace ironbird::scenarios {

/// What may be asked of an autopilot: the alternatives of autopilot::Request.
enum class RequestKind : std::uint8_t {
  kAddWaypoint,
  kRemoveWaypoint,
  kSetRoute,
  kClearRoute,
  kHoldHere,
  kRelease,
  kReturnToLaunch,
  kListRoute,
  kTakeOff,
  kLand,
  kResume,
  kSetParameter,
  kSwapModule,
  kOverrideSetpoint
};

constexpr std::array<std::pair<RequestKind, std::string_view>, 14> enumerators(RequestKind) {
  return {{{RequestKind::kAddWaypoint, "add_waypoint"},
           {RequestKind::kRemoveWaypoint, "remove_waypoint"},
           {RequestKind::kSetRoute, "set_route"},
           {RequestKind::kClearRoute, "clear_route"},
           {RequestKind::kHoldHere, "hold"},
           {RequestKind::kRelease, "release"},
           {RequestKind::kReturnToLaunch, "return_to_launch"},
           {RequestKind::kListRoute, "list_route"},
           {RequestKind::kTakeOff, "take_off"},
           {RequestKind::kLand, "land"},
           {RequestKind::kResume, "resume"},
           {RequestKind::kSetParameter, "set_parameter"},
           {RequestKind::kSwapModule, "swap_module"},
           {RequestKind::kOverrideSetpoint, "override_setpoint"}}};
}

/// Of which type a parameter's value is.
enum class SettingType : std::uint8_t { kTruth, kWhole, kNumber };

constexpr std::array<std::pair<SettingType, std::string_view>, 3> enumerators(SettingType) {
  return {{{SettingType::kTruth, "truth"}, {SettingType::kWhole, "whole"}, {SettingType::kNumber, "number"}}};
}

/// A parameter and the value that it was to have.
struct LoggedSetting {
  std::string path;
  SettingType type = SettingType::kNumber;
  double value = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("path", self.path, "", "in the table of parameters");
    visit("type", self.type, "1", "what the value is");
    visit("value", self.value, "SI", "in the unit of the parameter; of a truth 0 or 1");
  }
};

/// A request and what became of it, as a log keeps it: with the frames and the configuration the complete
/// input of a flight.
struct LoggedRequest {
  RequestKind kind = RequestKind::kListRoute;
  std::vector<autopilot::Waypoint> waypoints;
  bool cyclic = false;
  std::optional<std::uint32_t> index;
  std::optional<double> duration;
  std::string slot;
  std::string module_kind;
  std::vector<LoggedSetting> settings;
  std::optional<autopilot::ControlSetpoint> setpoint;
  bool accepted = false;
  std::string reason;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("kind", self.kind, "1", "what was asked for");
    visit("waypoints", self.waypoints, "", "of set_route; the one of add_waypoint");
    visit("cyclic", self.cyclic, "1", "of set_route: after the last comes the first");
    visit("index", self.index, "1", "of add_waypoint and remove_waypoint, from 0; absent: the end");
    visit("duration", self.duration, "s", "of hold; absent: until released");
    visit("slot", self.slot, "", "of swap_module");
    visit("module_kind", self.module_kind, "", "of swap_module: the newcomer");
    visit("settings", self.settings, "", "of swap_module; the one of set_parameter");
    visit("setpoint", self.setpoint, "", "of override_setpoint; absent: the follower flies again");
    visit("accepted", self.accepted, "1", "the autopilot did it");
    visit("reason", self.reason, "", "why it did not");
  }
};

/// Where a log has them.
inline constexpr std::string_view kRequestTopic = "/autopilot/request";

LoggedRequest logged(const autopilot::Request& request, const autopilot::RequestOutcome& outcome);

/// The request that was logged. @throws UserError when it lacks what its kind needs
autopilot::Request request_of(const LoggedRequest& logged);

}  // namespace ironbird::scenarios
