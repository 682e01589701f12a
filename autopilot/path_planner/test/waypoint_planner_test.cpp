#include "autopilot/path_planner/waypoint_planner.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "autopilot/handover.hpp"
#include "autopilot/math/local_map.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMicrometre = 1e-6;  // double precision at the earth's radius gives nanometres

Waypoint at(double north, double east, double down) {
  Waypoint waypoint;
  waypoint.p_N << north, east, down;
  return waypoint;
}

class WaypointPlannerTest : public ::testing::Test {
 protected:
  bool ask(const RouteRequest& request) { return planner_.request(request, estimate_); }
  const Route& run() {
    estimate_.stamp += std::chrono::milliseconds(10);
    return planner_.run(estimate_, flight_);
  }

  WaypointPlanner planner_;
  StateEstimate estimate_;
  FlightStatus flight_;
};

TEST_F(WaypointPlannerTest, BeginsWithNothingToFly) {
  EXPECT_TRUE(run().waypoints.empty());
  EXPECT_EQ(run().revision, 0u);
}

TEST_F(WaypointPlannerTest, AddsAtTheEndAndBeforeAnIndex) {
  EXPECT_TRUE(ask(AddWaypoint{at(1, 0, 0), {}}));
  EXPECT_TRUE(ask(AddWaypoint{at(3, 0, 0), {}}));
  EXPECT_TRUE(ask(AddWaypoint{at(2, 0, 0), 1}));
  const Route& route = run();
  ASSERT_EQ(route.waypoints.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(route.waypoints[static_cast<std::size_t>(i)].p_N.x(), i + 1.0);
  EXPECT_EQ(route.revision, 3u);
}

TEST_F(WaypointPlannerTest, NeverUsesANumberTwice) {
  ask(AddWaypoint{at(1, 0, 0), {}});
  const std::uint32_t first = run().waypoints[0].id;
  ask(RemoveWaypoint{0});
  ask(AddWaypoint{at(1, 0, 0), {}});
  EXPECT_GT(run().waypoints[0].id, first);
}

TEST_F(WaypointPlannerTest, RemovesClearsAndReplaces) {
  EXPECT_TRUE(ask(SetRoute{{at(1, 0, 0), at(2, 0, 0)}, true}));
  EXPECT_TRUE(run().cyclic);
  EXPECT_TRUE(ask(RemoveWaypoint{0}));
  EXPECT_EQ(run().waypoints.front().p_N.x(), 2.0);
  EXPECT_TRUE(ask(ClearRoute{}));
  EXPECT_TRUE(run().waypoints.empty());
}

struct RefusedCase {
  const char* name;
  RouteRequest request;
};

Waypoint spoiled(void (*spoil)(Waypoint&)) {
  Waypoint waypoint;
  spoil(waypoint);
  return waypoint;
}

class RefusedRequestTest : public ::testing::TestWithParam<RefusedCase> {};

TEST_P(RefusedRequestTest, ChangesNothing) {
  WaypointPlanner planner;
  const StateEstimate estimate;
  ASSERT_TRUE(planner.request(SetRoute{{at(1, 0, 0), at(2, 0, 0)}, false}, estimate));
  const std::uint32_t revision = planner.run(estimate, FlightStatus{}).revision;
  EXPECT_FALSE(planner.request(GetParam().request, estimate));
  EXPECT_EQ(planner.run(estimate, FlightStatus{}).revision, revision);
  EXPECT_EQ(planner.wanted().waypoints.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, RefusedRequestTest,
    ::testing::Values(
        RefusedCase{"IndexBeyondTheEnd", AddWaypoint{at(0, 0, 0), 3}},
        RefusedCase{"NothingToRemove", RemoveWaypoint{2}},
        RefusedCase{"PositionNotFinite", AddWaypoint{at(kNan, 0, 0), {}}},
        RefusedCase{"OutsideTheLocalMap", AddWaypoint{spoiled([](Waypoint& w) { w.p_N.y() = 2e5; }), {}}},
        RefusedCase{"HeadingNotFinite", AddWaypoint{spoiled([](Waypoint& w) { w.heading = kNan; }), {}}},
        RefusedCase{"NegativeSpeed", AddWaypoint{spoiled([](Waypoint& w) { w.speed = -1.0; }), {}}},
        RefusedCase{"SpeedNotFinite", AddWaypoint{spoiled([](Waypoint& w) { w.speed = kNan; }), {}}},
        RefusedCase{"NegativeHold", AddWaypoint{spoiled([](Waypoint& w) { w.hold_time = -1.0; }), {}}},
        RefusedCase{"LatitudeBeyondThePole", AddWaypoint{spoiled([](Waypoint& w) {
                                                           w.geodetic = GeodeticPosition{2.0, 0.0, 0.0};
                                                         }),
                                                         {}}},
        RefusedCase{"OneOfManyNotFinite", SetRoute{{at(0, 0, 0), at(0, kNan, 0)}, false}},
        RefusedCase{"TooMany", SetRoute{std::vector<Waypoint>(kMostWaypoints + 1), false}},
        RefusedCase{"HoldNotFinite", HoldHere{kNan}}, RefusedCase{"HoldNegative", HoldHere{-1.0}},
        RefusedCase{"ReturnBeforeTakeOff", ReturnToLaunch{}}),
    [](const auto& case_) { return case_.param.name; });

TEST_F(WaypointPlannerTest, HoldsAsManyWaypointsAsItSays) {
  for (std::size_t i = 0; i < kMostWaypoints; ++i) ASSERT_TRUE(ask(AddWaypoint{at(0, 0, 0), {}}));
  EXPECT_FALSE(ask(AddWaypoint{at(0, 0, 0), {}}));
}

TEST_F(WaypointPlannerTest, WaitsForTheOriginBeforeAPlaceOnTheEarthIsFlown) {
  // GIVEN a place 100 m north, 50 m east and 20 m above an origin that is not known yet
  const LocalOrigin origin{true, 40.0 * kDegree, -111.0 * kDegree, 1387.0};
  Waypoint waypoint;
  waypoint.geodetic = geodetic_from_local(Vector3(100.0, 50.0, -20.0), origin);
  ask(AddWaypoint{waypoint, {}});
  EXPECT_TRUE(planner_.waits_for_origin());
  EXPECT_TRUE(run().waypoints.empty());
  // WHEN the origin becomes known
  estimate_.origin = origin;
  const Route& route = run();
  // THEN the place is in the route, to the precision of a double
  ASSERT_EQ(route.waypoints.size(), 1u);
  EXPECT_FALSE(planner_.waits_for_origin());
  EXPECT_LT((route.waypoints[0].p_N - Vector3(100.0, 50.0, -20.0)).norm(), kMicrometre);
}

TEST_F(WaypointPlannerTest, KeepsTheRouteInForceWhileANewOneWaits) {
  ask(AddWaypoint{at(1, 0, 0), {}});
  Waypoint far;
  far.geodetic = GeodeticPosition{0.1, 0.1, 100.0};
  EXPECT_TRUE(ask(AddWaypoint{far, {}}));
  EXPECT_EQ(run().waypoints.size(), 1u);
}

TEST_F(WaypointPlannerTest, MovesPlacesOnTheEarthWithTheOrigin) {
  Waypoint waypoint;
  estimate_.origin = {true, 0.7, -1.9, 1000.0};
  waypoint.geodetic = GeodeticPosition{0.7, -1.9, 1010.0};
  ask(AddWaypoint{waypoint, {}});
  EXPECT_NEAR(run().waypoints[0].p_N.z(), -10.0, kMicrometre);
  estimate_.origin.altitude = 1005.0;
  EXPECT_NEAR(run().waypoints[0].p_N.z(), -5.0, kMicrometre);
}

TEST_F(WaypointPlannerTest, CountsHoldsAndReleases) {
  EXPECT_TRUE(ask(HoldHere{2.5}));
  EXPECT_EQ(run().holds, 1u);
  EXPECT_EQ(run().hold_time, 2.5);
  EXPECT_TRUE(ask(HoldHere{}));
  EXPECT_FALSE(run().hold_time.has_value());
  const std::uint32_t revision = run().revision;
  EXPECT_TRUE(ask(Release{}));
  EXPECT_EQ(run().released, 1u);
  EXPECT_EQ(run().revision, revision) << "a release is no new revision";
}

TEST_F(WaypointPlannerTest, ReturnsToWhereTheVehicleTookOffAndLandsThere) {
  // GIVEN a take-off at (3, 4) and a flight to a place below the height of return
  flight_.memory.launched = true;
  flight_.memory.launch_N << 3.0, 4.0, -1.0;
  flight_.memory.launch_heading = 0.5;
  estimate_.p_NB_N << 50.0, 60.0, -2.0;
  run();
  // WHEN asked to return
  EXPECT_TRUE(ask(ReturnToLaunch{}));
  // THEN it climbs on the spot, 5 m above the take-off, then flies to land over it
  const Route& route = run();
  ASSERT_EQ(route.waypoints.size(), 2u);
  EXPECT_EQ(route.waypoints[0].p_N, Vector3(50.0, 60.0, -6.0));
  EXPECT_EQ(route.waypoints[1].p_N, Vector3(3.0, 4.0, -6.0));
  EXPECT_EQ(route.waypoints[1].kind, WaypointKind::kLand);
  EXPECT_EQ(route.waypoints[1].heading, 0.5);
}

TEST_F(WaypointPlannerTest, TakesOverTheRouteOfItsPredecessor) {
  Signals signals;
  signals.route.waypoints = {at(1, 0, 0), at(2, 0, 0)};
  signals.route.waypoints[1].id = 7;
  signals.route.revision = 9;
  planner_.take_over(signals);
  EXPECT_EQ(run().waypoints.size(), 2u);
  EXPECT_EQ(run().revision, 9u);
  ask(AddWaypoint{at(3, 0, 0), {}});
  EXPECT_EQ(run().waypoints[2].id, 8u);
}

TEST_F(WaypointPlannerTest, ReturnsToTheLaunchThatItsPredecessorSaw) {
  Signals signals;
  signals.flight.memory.launched = true;
  signals.flight.memory.launch_N << 3.0, 4.0, -1.0;
  planner_.take_over(signals);
  estimate_.p_NB_N << 50.0, 60.0, -2.0;
  ASSERT_TRUE(ask(ReturnToLaunch{})) << "even before its first step";
  EXPECT_EQ(run().waypoints[1].p_N, Vector3(3.0, 4.0, -6.0));
}

TEST_F(WaypointPlannerTest, LeavesItsSuccessorTheWaypointsThatWaitForAnOrigin) {
  const LocalOrigin origin{true, 40.0 * kDegree, -111.0 * kDegree, 1387.0};
  Waypoint on_earth;
  on_earth.geodetic = geodetic_from_local(Vector3(100.0, 50.0, -20.0), origin);
  ask(AddWaypoint{at(1, 0, 0), {}});
  Signals last;
  last.route = run();
  ask(SetRoute{{on_earth}, true});
  // The estimate may have found the origin before the planner has worked on it, if that has a period.
  for (const LocalOrigin& known_by_now : {LocalOrigin{}, origin}) {
    estimate_.origin = last.estimate.origin = known_by_now;
    Handover left(last);
    planner_.hand_over(left);
    WaypointPlanner successor;
    successor.take_over(left);
    EXPECT_EQ(successor.waits_for_origin(), !known_by_now.known);
    EXPECT_EQ(successor.route().waypoints[0].p_N, Vector3(1.0, 0.0, 0.0)) << "in force meanwhile";
    estimate_.origin = origin;
    const Route& route = successor.run(estimate_, flight_);
    EXPECT_TRUE(route.cyclic);
    EXPECT_LT((route.waypoints[0].p_N - Vector3(100.0, 50.0, -20.0)).norm(), kMicrometre);
    EXPECT_GT(route.revision, last.route.revision);
  }
}

TEST_F(WaypointPlannerTest, LeavesARouteInForceAsItIs) {
  const LocalOrigin origin{true, 40.0 * kDegree, -111.0 * kDegree, 1387.0};
  Waypoint on_earth;
  on_earth.geodetic = geodetic_from_local(Vector3(100.0, 50.0, -20.0), origin);
  estimate_.origin = origin;
  ask(SetRoute{{on_earth}, true});
  Signals last;
  last.route = run();
  last.estimate = estimate_;
  Handover left(last);
  planner_.hand_over(left);
  WaypointPlanner successor;
  successor.take_over(left);
  EXPECT_EQ(successor.run(estimate_, flight_).revision, last.route.revision) << "or the manager plans anew";
}

TEST_F(WaypointPlannerTest, ForgetsEverythingOnReset) {
  ask(AddWaypoint{at(1, 0, 0), {}});
  planner_.reset();
  EXPECT_TRUE(run().waypoints.empty());
}

}  // namespace
}  // namespace ironbird::autopilot
