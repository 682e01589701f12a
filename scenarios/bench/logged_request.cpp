#include "scenarios/bench/logged_request.hpp"

#include <cmath>
#include <limits>
#include <variant>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

namespace {

using autopilot::Request;
using autopilot::RouteRequest;

LoggedSetting logged(const autopilot::ParameterSetting& setting) {
  LoggedSetting written{setting.first};
  if (const bool* truth = std::get_if<bool>(&setting.second)) {
    written.type = SettingType::kTruth;
    written.value = *truth ? 1.0 : 0.0;
  } else if (const int* whole = std::get_if<int>(&setting.second)) {
    written.type = SettingType::kWhole;
    written.value = *whole;
  } else {
    written.value = std::get<double>(setting.second);
  }
  return written;
}

bool fits_whole(double value) {
  return value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max();
}

autopilot::ParameterSetting setting_of(const LoggedSetting& written) {
  switch (written.type) {
    case SettingType::kTruth:
      return {written.path, written.value != 0.0};
    case SettingType::kWhole:
      if (!fits_whole(written.value)) throw UserError("a logged setting is no whole number");
      return {written.path, static_cast<int>(written.value)};
    case SettingType::kNumber:
      break;
  }
  return {written.path, written.value};
}

/// Notes in a log's form what was asked for.
class Writer {
 public:
  explicit Writer(LoggedRequest& out) : out_(out) {}

  void operator()(const RouteRequest& request) { std::visit(*this, request); }
  void operator()(const autopilot::AddWaypoint& request) {
    out_.kind = RequestKind::kAddWaypoint;
    out_.waypoints = {request.waypoint};
    out_.index = request.at;
  }
  void operator()(const autopilot::RemoveWaypoint& request) {
    out_.kind = RequestKind::kRemoveWaypoint;
    out_.index = request.index;
  }
  void operator()(const autopilot::SetRoute& request) {
    out_.kind = RequestKind::kSetRoute;
    out_.waypoints = request.waypoints;
    out_.cyclic = request.cyclic;
  }
  void operator()(const autopilot::ClearRoute&) { out_.kind = RequestKind::kClearRoute; }
  void operator()(const autopilot::HoldHere& request) {
    out_.kind = RequestKind::kHoldHere;
    out_.duration = request.duration;
  }
  void operator()(const autopilot::Release&) { out_.kind = RequestKind::kRelease; }
  void operator()(const autopilot::ReturnToLaunch&) { out_.kind = RequestKind::kReturnToLaunch; }
  void operator()(const autopilot::ListRoute&) { out_.kind = RequestKind::kListRoute; }
  void operator()(const autopilot::TakeOff&) { out_.kind = RequestKind::kTakeOff; }
  void operator()(const autopilot::Land&) { out_.kind = RequestKind::kLand; }
  void operator()(const autopilot::Resume&) { out_.kind = RequestKind::kResume; }
  void operator()(const autopilot::SetParameter& request) {
    out_.kind = RequestKind::kSetParameter;
    out_.settings = {logged({request.path, request.value})};
  }
  void operator()(const autopilot::SwapModule& request) {
    out_.kind = RequestKind::kSwapModule;
    out_.slot = request.slot;
    out_.module_kind = request.kind;
    for (const auto& setting : request.settings) out_.settings.push_back(logged(setting));
  }
  void operator()(const autopilot::OverrideSetpoint& request) {
    out_.kind = RequestKind::kOverrideSetpoint;
    out_.setpoint = request.setpoint;
  }

 private:
  LoggedRequest& out_;
};

template <class Value>
const Value& only(const std::vector<Value>& values, const char* what) {
  if (values.size() != 1) throw UserError("a logged request has " + std::to_string(values.size()) + what);
  return values.front();
}

std::uint32_t required(const std::optional<std::uint32_t>& index) {
  if (!index) throw UserError("a logged request has no index");
  return *index;
}

}  // namespace

LoggedRequest logged(const Request& request, const autopilot::RequestOutcome& outcome) {
  LoggedRequest out;
  std::visit(Writer(out), request);
  out.accepted = outcome.accepted;
  out.reason = outcome.reason;
  return out;
}

Request request_of(const LoggedRequest& written) {
  switch (written.kind) {
    case RequestKind::kAddWaypoint:
      return RouteRequest(
          autopilot::AddWaypoint{only(written.waypoints, " waypoints, not one"), written.index});
    case RequestKind::kRemoveWaypoint:
      return RouteRequest(autopilot::RemoveWaypoint{required(written.index)});
    case RequestKind::kSetRoute:
      return RouteRequest(autopilot::SetRoute{written.waypoints, written.cyclic});
    case RequestKind::kClearRoute:
      return RouteRequest(autopilot::ClearRoute{});
    case RequestKind::kHoldHere:
      return RouteRequest(autopilot::HoldHere{written.duration});
    case RequestKind::kRelease:
      return RouteRequest(autopilot::Release{});
    case RequestKind::kReturnToLaunch:
      return RouteRequest(autopilot::ReturnToLaunch{});
    case RequestKind::kListRoute:
      return autopilot::ListRoute{};
    case RequestKind::kTakeOff:
      return autopilot::TakeOff{};
    case RequestKind::kLand:
      return autopilot::Land{};
    case RequestKind::kResume:
      return autopilot::Resume{};
    case RequestKind::kSetParameter: {
      auto [path, value] = setting_of(only(written.settings, " settings, not one"));
      return autopilot::SetParameter{std::move(path), value};
    }
    case RequestKind::kSwapModule: {
      autopilot::SwapModule request{written.slot, written.module_kind};
      for (const LoggedSetting& setting : written.settings) request.settings.push_back(setting_of(setting));
      return request;
    }
    case RequestKind::kOverrideSetpoint:
      return autopilot::OverrideSetpoint{written.setpoint};
  }
  throw UserError("a logged request is of no kind that is known");
}

}  // namespace ironbird::scenarios
