#include "autopilot/autopilot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "autopilot/math/finite.hpp"
#include "autopilot/test/autopilot_flight.hpp"

namespace ironbird::autopilot {
namespace {

using ::testing::HasSubstr;

class AutopilotTest : public AutopilotFlight {};

TEST_F(AutopilotTest, FliesTheMissionOfThePaperAndLands) {
  ask(RouteRequest{
      SetRoute{{place(0, 0, -5), place(-20, 0, -8), place(-20, 20, -5), place(0, 0, -5, WaypointKind::kLand)},
               false}});
  take_off();
  double off_path = 0.0;
  ASSERT_TRUE(until(80.0, [&](const Signals& s) {
    if (s.flight.phase == FlightPhase::kOffboard) {
      off_path = std::max(off_path, (vehicle_.p_NB_N - s.trajectory.p_N).norm());
    }
    return s.flight.phase == FlightPhase::kLanding;
  }));
  EXPECT_LT(off_path, 0.15) << "m, all the way, against the moving reference";
  EXPECT_LT((vehicle_.p_NB_N - Vector3(0, 0, -5)).norm(), 0.5);
  // It lands, feels the ground, and stops its motors.
  ASSERT_TRUE(until(30.0, [](const Signals& s) {
    const auto* command = std::get_if<PassThroughCommand>(&s.command);
    return command != nullptr && command->thrust == 0.0;
  }));
  EXPECT_GT(vehicle_.p_NB_N.z(), -0.05);
  EXPECT_LT(vehicle_.p_NB_N.head<2>().norm(), 0.1);
}

TEST_F(AutopilotTest, FliesThroughWaypointsOnATrajectoryOfLeastSnap) {
  ask(SwapModule{"path_manager", "minimum_snap_manager"});
  ask(RouteRequest{SetRoute{{place(0, 10, -4), place(10, 10, -4), place(10, 0, -4)}, false}});
  take_off();
  double off_path = 0.0;
  ASSERT_TRUE(until(60.0, [&](const Signals& s) {
    if (s.flight.phase == FlightPhase::kOffboard) {
      off_path = std::max(off_path, (vehicle_.p_NB_N - s.trajectory.p_N).norm());
    }
    return s.trajectory.finished;
  }));
  EXPECT_LT(off_path, 0.3);
}

TEST_F(AutopilotTest, ReturnsToLaunchAndLands) {
  ask(RouteRequest{SetRoute{{place(15, 5, -6)}, false}});
  take_off();
  ASSERT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.finished; }));
  ask(RouteRequest{ReturnToLaunch{}});
  ASSERT_TRUE(until(60.0, [&](const Signals&) { return vehicle_.p_NB_N.z() > -0.01; }));
  EXPECT_LT(vehicle_.p_NB_N.head<2>().norm(), 0.2);
}

TEST_F(AutopilotTest, SwapsEveryModuleInFlightWithoutUpset) {
  ask(RouteRequest{SetRoute{{place(0, 0, -5), place(40, 0, -5)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.leg == 1; }));
  fly(6.0);
  for (const auto& [slot, kind] : {std::pair{"estimator", "external_pose"},
                                   {"path_planner", "waypoint_planner"},
                                   {"path_manager", "minimum_snap_manager"},
                                   {"path_manager", "smoothstep_manager"},
                                   {"trajectory_follower", "flat_pid_follower"},
                                   {"controller", "cascaded_controller"}}) {
    ask(SwapModule{slot, kind});
    double worst = 0.0;
    until(0.5, [&](const Signals& s) {
      worst = std::max(worst, (vehicle_.p_NB_N - s.trajectory.p_N).norm());
      return false;
    });
    EXPECT_LT(worst, 0.25) << slot << ": m, braking at the limit of acceleration";
    EXPECT_EQ(autopilot_.controller().phase(), FlightPhase::kOffboard) << slot;
  }
  EXPECT_TRUE(until(40.0, [](const Signals& s) { return s.trajectory.finished; }));
  EXPECT_LT((vehicle_.p_NB_N - Vector3(40, 0, -5)).norm(), 0.5);
}

TEST_F(AutopilotTest, ReturnsToLaunchWhateverWasExchangedOnTheWay) {
  vehicle_.p_NB_N << 4.0, -3.0, 0.0;
  ask(RouteRequest{SetRoute{{place(15, 5, -6)}, false}});
  take_off();
  ask(SwapModule{"controller", "cascaded_controller"});
  ASSERT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.finished; }));
  for (const auto& [slot, kind] : {std::pair{"path_planner", "waypoint_planner"},
                                   {"path_manager", "minimum_snap_manager"},
                                   {"trajectory_follower", "flat_pid_follower"},
                                   {"controller", "cascaded_controller"}}) {
    ask(SwapModule{slot, kind});
    fly(0.1);
  }
  ask(RouteRequest{ReturnToLaunch{}});
  ASSERT_TRUE(until(60.0, [&](const Signals&) { return vehicle_.p_NB_N.z() > -0.01; }));
  EXPECT_LT((vehicle_.p_NB_N - Vector3(4.0, -3.0, 0.0)).norm(), 0.2);
}

TEST_F(AutopilotTest, RefusesAnEstimatorThatCouldNotGoOn) {
  ask(RouteRequest{SetRoute{{place(0, 0, -5)}, false}});
  take_off();
  EXPECT_THAT(autopilot_.request(SwapModule{"estimator", "ekf"}).reason, HasSubstr("origin"))
      << "a pose from outside says nothing about the earth";
  // WHEN poses have not come for a while
  for (int i = 0; i < 500; ++i) {
    SensorFrame frame = vehicle_.frame();
    frame.external_pose.reset();
    vehicle_.fly(autopilot_.step(frame));
  }
  EXPECT_THAT(autopilot_.request(SwapModule{"estimator", "external_pose"}).reason, HasSubstr("no longer"));
  EXPECT_EQ(autopilot_.signals().flight.phase, FlightPhase::kSilent) << "it has neither place nor attitude";
}

TEST_F(AutopilotTest, RefusesPosesFromOutsideThatNeverCame) {
  AutopilotConfig config;
  Autopilot other(config, standard_modules());
  SensorFrame frame = vehicle_.frame();
  frame.external_pose.reset();
  other.step(frame);
  EXPECT_THAT(other.request(SwapModule{"estimator", "external_pose"}).reason, HasSubstr("ever arrived"));
}

TEST_F(AutopilotTest, FliesAnOperatorsSetpointWhileTheRouteWaits) {
  ask(RouteRequest{SetRoute{{place(0, 0, -5), place(30, 0, -5)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.leg == 1; }));
  fly(3.0);
  ask(OverrideSetpoint{PositionHeading{Vector3(5, 5, -6), 1.0}});
  fly(15.0);
  EXPECT_LT((vehicle_.p_NB_N - Vector3(5, 5, -6)).norm(), 0.1);
  EXPECT_EQ(autopilot_.signals().trajectory.leg, 1u);
  EXPECT_TRUE(autopilot_.signals().flight.setpoint_flies());
  EXPECT_FALSE(autopilot_.signals().flight.companion_flies()) << "nobody follows the trajectory";
  ask(OverrideSetpoint{});
  step();
  EXPECT_TRUE(autopilot_.signals().flight.companion_flies());
  EXPECT_LT((autopilot_.signals().trajectory.p_N - vehicle_.p_NB_N).norm(), 0.05) << "from where it is";
  EXPECT_TRUE(until(30.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_F(AutopilotTest, HoldsOnRequestWhilePilotsComeAndGo) {
  ask(RouteRequest{SetRoute{{place(40, 0, -5)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.v_N.norm() > 1.0; }));
  ask(RouteRequest{HoldHere{}});
  fly(5.0);
  EXPECT_TRUE(autopilot_.signals().trajectory.holding);
  EXPECT_LT(vehicle_.v_NB_N.norm(), 0.05);
  vehicle_.status.rc_override = 1;
  fly(1.0);
  vehicle_.status.rc_override = 0;
  fly(1.0);
  EXPECT_TRUE(autopilot_.signals().trajectory.holding);
  ask(RouteRequest{Release{}});
  EXPECT_TRUE(until(40.0, [](const Signals& s) { return s.trajectory.finished; }));
}

TEST_F(AutopilotTest, RepeatsAFlightToTheBit) {
  Autopilot other(on_external_pose(), standard_modules());
  const Request route = RouteRequest{SetRoute{{place(0, 5, -5)}, false}};
  for (Autopilot* each : {&autopilot_, &other}) {
    each->request(route);
  }
  vehicle_.status.armed = true;
  for (Autopilot* each : {&autopilot_, &other}) {
    each->step(vehicle_.frame());
    ASSERT_TRUE(each->request(TakeOff{}).accepted);
  }
  vehicle_.fly(SilenceCommand{});
  for (int i = 0; i < 4000; ++i) {
    const SensorFrame frame = vehicle_.frame();
    const FcuCommand command = autopilot_.step(frame);
    const FcuCommand again = other.step(frame);
    ASSERT_EQ(command.index(), again.index());
    if (const auto* a = std::get_if<PassThroughCommand>(&command)) {
      const auto& b = std::get<PassThroughCommand>(again);
      ASSERT_EQ(a->M_B, b.M_B);
      ASSERT_EQ(a->thrust, b.thrust);
    }
    vehicle_.fly(command);
  }
}

TEST_F(AutopilotTest, NeverPassesOnWhatIsNotFinite) {
  ask(RouteRequest{SetRoute{{place(10, 0, -5)}, true}});
  take_off();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 2000; ++i) {
    SensorFrame frame = vehicle_.frame();
    switch (i % 7) {
      case 1:
        frame.imu.w_NB_B.x() = nan;
        break;
      case 2:
        frame.imu.f_B.z() = std::numeric_limits<double>::infinity();
        break;
      case 3:
        frame.external_pose->p_NB_N.y() = nan;
        break;
      case 4:
        frame.external_pose->q_NB.w() = nan;
        break;
      case 5:
        frame.external_pose.reset();
        frame.status->battery_voltage = nan;
        break;
      default:
        break;
    }
    ASSERT_TRUE(all_finite(autopilot_.step(frame))) << i;
    vehicle_.fly(autopilot_.signals().command);
  }
  EXPECT_LT((vehicle_.p_NB_N - Vector3(10, 0, -5)).norm(), 10.0) << "and it flies on";
  EXPECT_LT(vehicle_.p_NB_N.z(), -1.0);
}

TEST_F(AutopilotTest, NamesSlotKindAndKindsWhenAKindIsUnknown) {
  AutopilotConfig config = on_external_pose();
  config.path_manager.kind = "teleporter";
  try {
    Autopilot(config, standard_modules());
    FAIL() << "it was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("path_manager.kind = \"teleporter\""));
    EXPECT_THAT(error.what(), HasSubstr("minimum_snap_manager, smoothstep_manager"));
  }
}

TEST_F(AutopilotTest, RefusesANegativePeriod) {
  AutopilotConfig config = on_external_pose();
  config.controller.period = Time{-1};
  EXPECT_THROW(Autopilot(config, standard_modules()), std::invalid_argument);
}

TEST_F(AutopilotTest, RefusesSwapsThatCannotBeAndKeepsFlying) {
  EXPECT_THAT(autopilot_.request(SwapModule{"controller", "magic"}).reason, HasSubstr("cascaded_controller"));
  EXPECT_THAT(autopilot_.request(SwapModule{"engine", "warp"}).reason, HasSubstr("trajectory_follower"));
  EXPECT_NE(autopilot_.parameters().find("controller.mass"), nullptr);
  step();
}

TEST_F(AutopilotTest, ListsTheWaypointsThatAreWanted) {
  Waypoint second = place(-20, 0.5, -8, WaypointKind::kHold);
  second.hold_time = 10.0;
  second.speed = 1.5;
  ask(RouteRequest{SetRoute{{place(0, 0, -5), second}, false}});
  const RequestOutcome outcome = autopilot_.request(ListRoute{});
  ASSERT_TRUE(outcome.accepted);
  ASSERT_EQ(outcome.waypoints.size(), 2u);
  EXPECT_EQ(outcome.waypoints[0].p_N, Vector3(0, 0, -5));
  EXPECT_EQ(outcome.waypoints[1].kind, WaypointKind::kHold);
  EXPECT_EQ(outcome.waypoints[1].hold_time, 10.0);
}

TEST_F(AutopilotTest, RefusesToReturnToLaunchOnTheGroundBeforeAndAfterAFlight) {
  const auto refusal = [&] { return autopilot_.request(RouteRequest{ReturnToLaunch{}}).reason; };
  ask(RouteRequest{SetRoute{{place(0, 0, -3)}, false}});
  step();
  EXPECT_EQ(refusal(), "it is on the ground");
  take_off();
  fly(3.0);
  EXPECT_EQ(refusal(), "");
  ASSERT_TRUE(until(40.0, [](const Signals& s) { return s.flight.memory.on_ground; }));
  EXPECT_EQ(refusal(), "it is on the ground");
}

TEST_F(AutopilotTest, RefusesASetpointWhileItDescendsUntilAskedToResume) {
  ask(RouteRequest{SetRoute{{place(0, 0, -5)}, false}});
  take_off();
  fly(8.0);
  ask(Land{});
  fly(1.0);
  const RequestOutcome refused =
      autopilot_.request(OverrideSetpoint{PositionHeading{Vector3(0, 0, -9), 0.0}});
  EXPECT_FALSE(refused.accepted);
  EXPECT_THAT(refused.reason, HasSubstr("resume"));
  ask(Resume{});
  step();
  ask(OverrideSetpoint{PositionHeading{Vector3(0, 0, -9), 0.0}});
  fly(10.0);
  EXPECT_LT((vehicle_.p_NB_N - Vector3(0, 0, -9)).norm(), 0.3);
}

TEST_F(AutopilotTest, RefusesParametersThatDoNotFitTogether) {
  ask(SetParameter{"controller.min_throttle", 0.9});
  const RequestOutcome refused = autopilot_.request(SetParameter{"controller.max_throttle", 0.2});
  EXPECT_FALSE(refused.accepted);
  EXPECT_THAT(refused.reason, HasSubstr("min_throttle must be less than max_throttle"));
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.landing_speed", 0.1}).accepted)
      << "slower than what is felt as the ground";
  EXPECT_FALSE(autopilot_.request(SetParameter{"trajectory_follower.max_thrust", 1.0}).accepted);
}

TEST_F(AutopilotTest, RefusesParametersWithAReason) {
  const auto reason = [&](const std::string& path, const ParameterValue& value) {
    return autopilot_.request(SetParameter{path, value}).reason;
  };
  EXPECT_THAT(reason("controller.mess", 1.0), HasSubstr("unknown"));
  EXPECT_THAT(reason("controller.mass", true), HasSubstr("wrong type"));
  EXPECT_THAT(reason("controller.mass", 1e9), HasSubstr("100"));
  EXPECT_THAT(reason("controller.mass", std::numeric_limits<double>::quiet_NaN()), HasSubstr("not finite"));
  EXPECT_EQ(reason("trajectory_follower.north.kp", 2.0), "");
  EXPECT_EQ(reason("path_manager.switch_early", true), "");
}

TEST_F(AutopilotTest, ActsOnAParameterFromTheNextStepOn) {
  ask(RouteRequest{SetRoute{{place(0, 0, -5)}, false}});
  take_off();
  fly(8.0);
  const double before = std::get<AngleHeadingRateThrust>(autopilot_.signals().setpoint).thrust;
  ask(SetParameter{"trajectory_follower.mass", 3.8});
  step();
  EXPECT_NEAR(std::get<AngleHeadingRateThrust>(autopilot_.signals().setpoint).thrust / before, 3.8 / 3.9,
              1e-3);
}

TEST_F(AutopilotTest, RefusesASetpointThatIsNotFinite) {
  RateThrust setpoint;
  setpoint.thrust = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(autopilot_.request(OverrideSetpoint{setpoint}).accepted);
}

TEST_F(AutopilotTest, ShowsTheRouteInItsSignals) {
  step();
  ask(RouteRequest{SetRoute{{place(0, 0, -5)}, false}});
  EXPECT_EQ(step().route.waypoints.size(), 1u);
  ask(RouteRequest{Release{}});
  EXPECT_EQ(step().route.released, 1u);
  ask(SwapModule{"path_planner", "waypoint_planner"});
  EXPECT_EQ(step().route.waypoints.size(), 1u);
}

TEST_F(AutopilotTest, DescribesEveryParameterWithUnitAndMeaning) {
  EXPECT_GT(autopilot_.parameters().slots().size(), 50u);
  for (const ParameterSlot& slot : autopilot_.parameters().slots()) {
    EXPECT_FALSE(slot.unit.empty()) << slot.path;
    EXPECT_FALSE(slot.description.empty()) << slot.path;
    if (const auto* const* value = std::get_if<double*>(&slot.value)) {
      EXPECT_GE(**value, slot.lower) << slot.path;
      EXPECT_LE(**value, slot.upper) << slot.path;
    }
  }
}

}  // namespace
}  // namespace ironbird::autopilot
