// Every request there is, into a log and back.

#include "scenarios/bench/logged_request.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/cdr.hpp"
#include "scenarios/record/cdr_decoder.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Request;
using autopilot::RouteRequest;

std::string bytes_of(const LoggedRequest& request) {
  ByteBuffer out;
  encode_cdr(request, out);
  return {reinterpret_cast<const char*>(out.data()), out.size()};
}

LoggedRequest through_bytes(const LoggedRequest& request) {
  ByteBuffer out;
  encode_cdr(request, out);
  return decode_cdr<LoggedRequest>(out.bytes());
}

autopilot::Waypoint waypoint() {
  autopilot::Waypoint waypoint;
  waypoint.kind = autopilot::WaypointKind::kHold;
  waypoint.p_N = {1.0, -2.0, -3.0};
  waypoint.geodetic = autopilot::GeodeticPosition{0.7, -1.9, 1400.0};
  waypoint.heading = 0.1;
  waypoint.hold_time = 12.5;
  waypoint.id = 7;
  return waypoint;
}

/// One of each alternative, with and without what may be absent.
std::vector<Request> all_requests() {
  std::vector<Request> all{
      RouteRequest(autopilot::AddWaypoint{waypoint(), 3}),
      RouteRequest(autopilot::AddWaypoint{waypoint(), std::nullopt}),
      RouteRequest(autopilot::RemoveWaypoint{4}),
      RouteRequest(autopilot::SetRoute{{waypoint(), autopilot::Waypoint{}}, true}),
      RouteRequest(autopilot::ClearRoute{}),
      RouteRequest(autopilot::HoldHere{2.5}),
      RouteRequest(autopilot::HoldHere{std::nullopt}),
      RouteRequest(autopilot::Release{}),
      RouteRequest(autopilot::ReturnToLaunch{}),
      autopilot::ListRoute{},
      autopilot::TakeOff{},
      autopilot::Land{},
      autopilot::Resume{},
      autopilot::SetParameter{"controller.mass", 3.25},
      autopilot::SetParameter{"estimator.steps", -7},
      autopilot::SetParameter{"estimator.doppler", true},
      autopilot::SwapModule{"estimator", "ekf", {{"a.b", 1}, {"a.c", false}, {"a.d", 0.1}}},
      autopilot::OverrideSetpoint{std::nullopt},
      autopilot::OverrideSetpoint{autopilot::TorqueThrust{{1.0, 2.0, 3.0}, 4.0}}};
  return all;
}

TEST(LoggedRequestTest, ComesBackOutOfALogAsItWentIn) {
  std::size_t kinds = 0;
  std::vector<bool> seen(enumerators(RequestKind{}).size());
  for (const Request& request : all_requests()) {
    const LoggedRequest written = logged(request, {false, "because"});
    const LoggedRequest read = through_bytes(written);
    EXPECT_EQ(bytes_of(logged(request_of(read), {read.accepted, read.reason})), bytes_of(written));
    EXPECT_EQ(request_of(read).index(), request.index());
    EXPECT_EQ(read.reason, "because");
    auto known = seen[static_cast<std::size_t>(read.kind)];
    if (!known) ++kinds;
    known = true;
  }
  EXPECT_EQ(kinds, seen.size()) << "every kind of request is tried";
}

TEST(LoggedRequestTest, KeepsTheTypeOfAParametersValue) {
  const auto back = [](const autopilot::ParameterValue& value) {
    const Request request = autopilot::SetParameter{"p", value};
    return std::get<autopilot::SetParameter>(request_of(through_bytes(logged(request, {})))).value;
  };
  EXPECT_EQ(back(true), autopilot::ParameterValue(true));
  EXPECT_EQ(back(std::numeric_limits<int>::min()),
            autopilot::ParameterValue(std::numeric_limits<int>::min()));
  EXPECT_EQ(back(0.1 + 0.2), autopilot::ParameterValue(0.1 + 0.2));
}

TEST(LoggedRequestTest, RefusesWhatLacksWhatItsKindNeeds) {
  LoggedRequest request;
  request.kind = RequestKind::kAddWaypoint;
  EXPECT_THROW(request_of(request), UserError);
  request.kind = RequestKind::kRemoveWaypoint;
  EXPECT_THROW(request_of(request), UserError);
  request.kind = RequestKind::kSetParameter;
  EXPECT_THROW(request_of(request), UserError);
  request.settings = {{"p", SettingType::kWhole, 1e20}};
  EXPECT_THROW(request_of(request), UserError);
  request.settings = {{"p", SettingType::kWhole, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THROW(request_of(request), UserError);
}

}  // namespace
}  // namespace ironbird::scenarios
