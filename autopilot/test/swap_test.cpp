#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "autopilot/test/autopilot_flight.hpp"

namespace ironbird::autopilot {
namespace {

struct Swap {
  const char* name;
  const char* slot;
  const char* kind;
};

/// Every slot, exchanged in every situation that a successor could forget.
class SwapTest : public AutopilotFlight, public ::testing::WithParamInterface<Swap> {
 protected:
  void swap() { ask(SwapModule{GetParam().slot, GetParam().kind, {}}); }
};

TEST_P(SwapTest, LeavesAHoldAtAWaypointItsLength) {
  Waypoint hold = place(0, 2, -4, WaypointKind::kHold);
  hold.hold_time = 6.0;
  ask(RouteRequest{SetRoute{{hold, place(0, 9, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.holding; }));
  fly(4.0);
  swap();
  double left = 0.0;
  ASSERT_TRUE(until(20.0, [&](const Signals& s) {
    left += 0.0025;
    return s.trajectory.leg == 1;
  }));
  EXPECT_NEAR(left, 2.0, 0.05);
  EXPECT_EQ(autopilot_.signals().trajectory.reached, 1u);
}

TEST_P(SwapTest, LeavesAHoldOnTheSpotInForceUntilReleased) {
  ask(RouteRequest{SetRoute{{place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  ask(RouteRequest{HoldHere{}});
  fly(5.0);
  const Vector3 place_N = vehicle_.p_NB_N;
  swap();
  fly(20.0);
  EXPECT_TRUE(autopilot_.signals().trajectory.holding);
  EXPECT_LT((vehicle_.p_NB_N - place_N).norm(), 0.05);
  ask(RouteRequest{Release{}});
  EXPECT_TRUE(until(40.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_P(SwapTest, LandsWhereTheLandingBegan) {
  ask(RouteRequest{SetRoute{{place(3, 0, -6)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.finished; }));
  ask(Land{});
  ASSERT_TRUE(until(20.0, [&](const Signals&) { return vehicle_.p_NB_N.z() > -4.0; }));
  swap();
  double highest = -vehicle_.p_NB_N.z();
  ASSERT_TRUE(until(30.0, [&](const Signals& s) {
    highest = std::max(highest, -vehicle_.p_NB_N.z());
    const auto* command = std::get_if<PassThroughCommand>(&s.command);
    return command != nullptr && command->thrust == 0.0;
  }));
  EXPECT_LT(highest, 4.05);
  EXPECT_GT(vehicle_.p_NB_N.z(), -0.05);
  EXPECT_LT((vehicle_.p_NB_N - Vector3(3, 0, 0)).norm(), 0.1);
}

TEST_P(SwapTest, DoesNotSagByALostIntegral) {
  // GIVEN a follower that thinks the vehicle lighter than it is, and whose integral has made up for it
  ask(SetParameter{"trajectory_follower.mass", 3.3});
  ask(SetParameter{"trajectory_follower.down.ki", 3.0});
  ask(RouteRequest{SetRoute{{place(0, 0, -5)}, false}});
  take_off();
  fly(40.0);
  const double down = vehicle_.p_NB_N.z();
  swap();
  double worst = 0.0;
  until(5.0, [&](const Signals&) {
    worst = std::max(worst, std::abs(vehicle_.p_NB_N.z() - down));
    return false;
  });
  EXPECT_LT(worst, 0.02) << "m; without its integral 0.12";
}

TEST_P(SwapTest, HoldsTheHeightOfTheHoldAfterTakeOff) {
  // GIVEN a controller that thinks the vehicle lighter than it is
  ask(SetParameter{"controller.mass", 3.5});
  ask(SetParameter{"controller.take_off_hold_time", 30.0});
  ask(RouteRequest{SetRoute{{place(0, 0, -2)}, false}});
  take_off();
  fly(20.0);
  const double down = vehicle_.p_NB_N.z();
  swap();
  double worst = 0.0;
  until(5.0, [&](const Signals& s) {
    EXPECT_EQ(s.flight.phase, FlightPhase::kHold);
    worst = std::max(worst, std::abs(vehicle_.p_NB_N.z() - down));
    return false;
  });
  EXPECT_LT(worst, 0.02);
}

TEST_P(SwapTest, KeepsWhatTheOperatorHasSet) {
  step();
  ask(SetParameter{"controller.mass", 3.0});
  ask(SetParameter{"path_manager.max_acceleration", 0.5});
  ask(SetParameter{"trajectory_follower.north.kp", 3.0});
  ask(SetParameter{"path_planner.return_height", 7.0});
  swap();
  EXPECT_EQ(autopilot_.parameters().get("controller.mass"), ParameterValue(3.0));
  EXPECT_EQ(autopilot_.parameters().get("path_manager.max_acceleration"), ParameterValue(0.5));
  EXPECT_EQ(autopilot_.parameters().get("trajectory_follower.north.kp"), ParameterValue(3.0));
  EXPECT_EQ(autopilot_.parameters().get("path_planner.return_height"), ParameterValue(7.0));
}

TEST_P(SwapTest, BrakesNoHarderThanTheOperatorHasAllowed) {
  ask(SetParameter{"path_manager.max_acceleration", 0.5});
  ask(RouteRequest{SetRoute{{place(60, 0, -3)}, false}});
  take_off();
  ASSERT_TRUE(until(40.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 2.0; }));
  swap();
  double hardest = 0.0;
  until(5.0, [&](const Signals& s) {
    hardest = std::max(hardest, s.trajectory.a_N.norm());
    return false;
  });
  EXPECT_LT(hardest, 0.51);
}

TEST_P(SwapTest, LandsWhenAskedToBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(0, 0, -4)}, false}});
  take_off();
  fly(6.0);
  ask(Land{});
  swap();
  step();
  step();
  EXPECT_EQ(autopilot_.signals().flight.phase, FlightPhase::kLanding);
}

TEST_P(SwapTest, TakesOffWhenAskedToBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(0, 0, -4)}, false}});
  vehicle_.status.armed = true;
  step();
  ask(TakeOff{});
  swap();
  step();
  step();
  EXPECT_EQ(autopilot_.signals().flight.phase, FlightPhase::kTakeOff);
}

TEST_P(SwapTest, FliesTheRouteThatWasSetBeforeTheFirstTick) {
  if (std::string_view(GetParam().slot) == "estimator") GTEST_SKIP() << "it wants to hear a pose first";
  ask(RouteRequest{SetRoute{{place(2, 0, -4), place(4, 0, -4)}, true}});
  swap();
  take_off();
  EXPECT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.reached == 3; }));
}

TEST_P(SwapTest, HoldsWhenAskedToBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  ask(RouteRequest{HoldHere{6.0}});
  swap();
  EXPECT_TRUE(until(5.0, [](const Signals& s) { return s.trajectory.holding; }));
  EXPECT_TRUE(until(40.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_P(SwapTest, FliesOnWhenReleasedBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(10, 0, -4)}, false}});
  take_off();
  fly(3.0);
  ask(RouteRequest{HoldHere{}});
  ASSERT_TRUE(until(5.0, [](const Signals& s) { return s.trajectory.holding; }));
  ask(RouteRequest{Release{}});
  swap();
  EXPECT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_P(SwapTest, FliesOnFromAWaypointWhenReleasedBetweenTheSameTwoTicks) {
  for (const bool swap_first : {false, true}) {
    Waypoint hold = place(0, 2, -4, WaypointKind::kHold);
    hold.hold_indefinitely = true;
    ask(RouteRequest{SetRoute{{hold, place(0, 6, -4)}, false}});
    if (!swap_first) take_off();
    ASSERT_TRUE(
        until(40.0, [](const Signals& s) { return s.trajectory.holding && s.trajectory.at_waypoint; }));
    fly(1.0);
    if (swap_first) swap();
    ask(RouteRequest{Release{}});
    if (!swap_first) swap();
    EXPECT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.finished; })) << swap_first;
  }
}

TEST_P(SwapTest, TakesTheLastWordOfAHoldAndARelease) {
  ask(RouteRequest{SetRoute{{place(60, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  ask(RouteRequest{HoldHere{}});
  ask(RouteRequest{Release{}});
  swap();
  EXPECT_FALSE(until(5.0, [](const Signals& s) { return s.trajectory.holding; }));
  ask(RouteRequest{Release{}});
  ask(RouteRequest{HoldHere{}});
  swap();
  EXPECT_TRUE(until(5.0, [](const Signals& s) { return s.trajectory.holding; }));
  // A hold in force that is released and asked for anew goes on.
  ask(RouteRequest{Release{}});
  ask(RouteRequest{HoldHere{}});
  fly(5.0);
  EXPECT_TRUE(autopilot_.signals().trajectory.holding);
  ask(RouteRequest{Release{}});
  EXPECT_TRUE(until(60.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_P(SwapTest, TakesTheLastWordOfALandingAndItsEnd) {
  ask(RouteRequest{SetRoute{{place(0, 0, -6)}, false}});
  take_off();
  fly(8.0);
  ask(Land{});
  fly(1.0);
  ask(Resume{});
  ask(Land{});
  swap();
  fly(0.1);
  EXPECT_EQ(autopilot_.signals().flight.phase, FlightPhase::kLanding);
  ask(Resume{});
  fly(0.1);
  EXPECT_EQ(autopilot_.signals().flight.phase, FlightPhase::kHold);
}

TEST_P(SwapTest, EditsTheRouteWhenAskedToBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(3, 0, -4), place(6, 0, -4), place(6, 6, -4)}, false}});
  take_off();
  fly(1.0);
  ask(RouteRequest{RemoveWaypoint{1}});
  swap();
  step();
  ASSERT_EQ(autopilot_.signals().route.waypoints.size(), 2u);
  ask(RouteRequest{AddWaypoint{place(0, 6, -4), {}}});
  swap();
  swap();
  step();
  ASSERT_EQ(autopilot_.signals().route.waypoints.size(), 3u);
  ASSERT_TRUE(until(60.0, [](const Signals& s) { return s.trajectory.finished; }));
  EXPECT_EQ(autopilot_.signals().trajectory.reached, 3u);
  EXPECT_LT((vehicle_.p_NB_N - Vector3(0, 6, -4)).norm(), 0.6);
}

TEST_P(SwapTest, FliesANewRouteFromItsBeginningThoughTheLastWaypointOfTheOldOneWasRemoved) {
  ask(RouteRequest{SetRoute{{place(3, 0, -4), place(6, 0, -4), place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.leg == 1; }));
  ask(RouteRequest{RemoveWaypoint{2}});
  swap();
  ask(RouteRequest{SetRoute{{place(3, 3, -4), place(6, 3, -4), place(9, 3, -4)}, false}});
  step();
  EXPECT_EQ(autopilot_.signals().trajectory.leg, 0u);
}

TEST_P(SwapTest, ReturnsWhenAskedToBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(10, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.finished; }));
  ask(RouteRequest{ReturnToLaunch{}});
  swap();
  ASSERT_TRUE(until(40.0, [](const Signals& s) { return s.flight.phase == FlightPhase::kLanding; }));
  EXPECT_LT(vehicle_.p_NB_N.head<2>().norm(), 0.5);
}

TEST_P(SwapTest, StaysWhereItIsWhenTheRouteWasClearedBetweenTheSameTwoTicks) {
  ask(RouteRequest{SetRoute{{place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  ask(RouteRequest{ClearRoute{}});
  swap();
  fly(10.0);
  EXPECT_TRUE(autopilot_.signals().route.waypoints.empty());
  EXPECT_LT(vehicle_.v_NB_N.norm(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Slots, SwapTest,
                         ::testing::Values(Swap{"Estimator", "estimator", "external_pose"},
                                           Swap{"Planner", "path_planner", "waypoint_planner"},
                                           Swap{"SameManager", "path_manager", "smoothstep_manager"},
                                           Swap{"OtherManager", "path_manager", "minimum_snap_manager"},
                                           Swap{"Follower", "trajectory_follower", "flat_pid_follower"},
                                           Swap{"Controller", "controller", "cascaded_controller"}),
                         [](const auto& case_) { return case_.param.name; });

struct ManagerSwap {
  const char* name;
  const char* from;
  const char* to;
};

class ManagerSwapTest : public ::testing::TestWithParam<ManagerSwap> {};

/// One flight along a route with corners, in which the path manager is exchanged.
class OneFlight : public AutopilotFlight {
 public:
  /// The greatest body rate in the second after the exchange, rad/s.
  double twitch(const ManagerSwap& swap, double at) {
    ask(SwapModule{"path_manager", swap.from, {}});
    ask(RouteRequest{SetRoute{{place(15, 0, -6), place(15, 15, -8), place(0, 15, -6)}, false}});
    take_off();
    fly(at);
    ask(SwapModule{"path_manager", swap.to, {}});
    double greatest = 0.0;
    until(1.0, [&](const Signals&) {
      greatest = std::max(greatest, vehicle_.w_NB_B.norm());
      return false;
    });
    return greatest;
  }

 private:
  void TestBody() override {}
};

TEST_P(ManagerSwapTest, DoesNotMakeTheVehicleTwitchWheneverItComes) {
  constexpr double kTwitch = 1.5;  // rad/s, 86 deg/s: what a leg of few centimetres asks for
  for (double at = 0.5; at < 32.0; at += 0.5) {
    OneFlight flight;
    EXPECT_LT(flight.twitch(GetParam(), at), kTwitch) << at << " s after take-off";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Managers, ManagerSwapTest,
    ::testing::Values(ManagerSwap{"LegsToLegs", "smoothstep_manager", "smoothstep_manager"},
                      ManagerSwap{"LegsToCurves", "smoothstep_manager", "minimum_snap_manager"},
                      ManagerSwap{"CurvesToLegs", "minimum_snap_manager", "smoothstep_manager"},
                      ManagerSwap{"CurvesToCurves", "minimum_snap_manager", "minimum_snap_manager"}),
    [](const auto& swap) { return swap.param.name; });

/// Modules that work every tenth of a second, and what was asked for while they rest.
class SlowSwapTest : public AutopilotFlight {
 protected:
  static AutopilotConfig slow() {
    AutopilotConfig config = on_external_pose();
    config.path_manager.period = config.path_planner.period = std::chrono::milliseconds(100);
    return config;
  }
  SlowSwapTest() : AutopilotFlight(standard_modules(), slow()) {}
};

TEST_F(SlowSwapTest, HoldsThoughTheManagerWasExchangedBeforeItHadTimeToNotice) {
  ask(RouteRequest{SetRoute{{place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  const Time worked = autopilot_.signals().trajectory.stamp;
  ASSERT_TRUE(until(0.2, [&](const Signals& s) { return s.trajectory.stamp != worked; }));
  ask(RouteRequest{HoldHere{}});
  fly(0.05);
  ask(SwapModule{"path_manager", "minimum_snap_manager", {}});
  EXPECT_TRUE(until(5.0, [](const Signals& s) { return s.trajectory.holding; }));
}

TEST_F(SlowSwapTest, FliesANewRouteFromItsBeginningThoughTheManagerHadNoTimeToNotice) {
  ask(RouteRequest{SetRoute{{place(3, 0, -4), place(40, 0, -4)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.leg == 1; }));
  ask(RouteRequest{SetRoute{{place(3, 3, -4), place(6, 3, -4)}, false}});
  fly(0.05);
  ASSERT_EQ(autopilot_.signals().trajectory.leg, 1u);
  ask(SwapModule{"path_manager", "smoothstep_manager", {}});
  step();
  EXPECT_EQ(autopilot_.signals().trajectory.leg, 0u);
}

using SwapSettingsTest = AutopilotFlight;

TEST_F(SwapSettingsTest, GiveTheNewcomerItsOwnParametersBeforeItTakesOver) {
  ask(SwapModule{"path_manager", "minimum_snap_manager", {{"path_manager.max_excursion", 3.0}}});
  EXPECT_EQ(autopilot_.parameters().get("path_manager.max_excursion"), ParameterValue(3.0));
}

TEST_F(SwapSettingsTest, AreRefusedWithTheSwapWhenTheyDoNotFitTogether) {
  const RequestOutcome outcome =
      autopilot_.request(SwapModule{"controller", "cascaded_controller", {{"controller.min_thrust", 90.0}}});
  EXPECT_FALSE(outcome.accepted);
  EXPECT_NE(outcome.reason.find("min_thrust must be less than max_thrust"), std::string::npos)
      << outcome.reason;
  EXPECT_EQ(autopilot_.parameters().get("controller.min_thrust"), ParameterValue(2.0));
}

}  // namespace
}  // namespace ironbird::autopilot
