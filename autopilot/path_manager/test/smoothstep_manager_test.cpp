#include "autopilot/path_manager/smoothstep_manager.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "autopilot/handover.hpp"
#include "autopilot/math/smoothstep.hpp"
#include "autopilot/path_manager/test/perfect_flight.hpp"

namespace ironbird::autopilot {
namespace {

class SmoothstepManagerTest : public ::testing::Test {
 protected:
  SmoothstepManager manager_;
  PerfectFlight flight_{manager_};
};

TEST_F(SmoothstepManagerTest, HasNothingToFlyWithoutARouteOrAnEstimate) {
  EXPECT_FALSE(flight_.step().valid);
  flight_.set({waypoint(1, Vector3(1, 0, 0))});
  flight_.estimate.health = Health::kUninitialised;
  EXPECT_FALSE(flight_.step().valid);
  flight_.estimate.health = Health::kDegraded;
  EXPECT_TRUE(flight_.step().valid);
}

TEST_F(SmoothstepManagerTest, StartsWhereTheVehicleIsAndFollowsTheClosedForm) {
  // GIVEN a vehicle at (1, 2, -3), heading 0.3, and a waypoint 20 m away
  flight_.estimate.p_NB_N << 1.0, 2.0, -3.0;
  flight_.estimate.heading = 0.3;
  flight_.follows = false;
  const Vector3 way(0.0, 20.0, 0.0);
  flight_.set({waypoint(1, Vector3(1.0, 22.0, -3.0), 1.3)});
  const double duration = 1.875 * 20.0 / 3.0;
  flight_.step();
  // THEN every point lies on the smooth step whose clock began at the first tick
  for (int i = 1; i < duration / PerfectFlight::kDt; ++i) {
    const TrajectoryPoint& point = flight_.step();
    const Smoothstep s = smoothstep(i * PerfectFlight::kDt / duration);
    ASSERT_LT((point.p_N - Vector3(1, 2, -3) - s.value * way).norm(), kRoundOff);
    ASSERT_LT((point.v_N - s.first / duration * way).norm(), kRoundOff);
    ASSERT_LT((point.a_N - s.second / (duration * duration) * way).norm(), kRoundOff);
    ASSERT_NEAR(point.heading, 0.3 + s.value, kRoundOff);
    ASSERT_NEAR(point.heading_rate, s.first / duration, kRoundOff);
    ASSERT_NEAR(point.heading_acceleration, s.second / (duration * duration), kRoundOff);
  }
}

TEST_F(SmoothstepManagerTest, MovesItsReferenceAlongWhenThePositionJumpsAndMakesItsWayFromThere) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.fly(5.0);
  const TrajectoryPoint before = flight_.last;
  ASSERT_GT(before.v_N.x(), 1.0);
  // WHEN the position jumps by 30 m to the right
  const Vector3 jump_N(0.0, 30.0, 0.0);
  flight_.estimate.p_NB_N += jump_N;
  flight_.estimate.position_reset_sum_N += jump_N;
  ++flight_.estimate.position_resets;
  // THEN the reference is where it would have been, beside, and as fast
  const TrajectoryPoint after = flight_.step();
  EXPECT_LT((after.p_N - before.p_N - jump_N).norm(), 1.5 * PerfectFlight::kDt * before.v_N.norm());
  EXPECT_LT((after.v_N - before.v_N).norm(), 1.5 * PerfectFlight::kDt * 2.5);
  // AND within its limits it comes to the waypoint all the same
  double fastest = 0.0;
  EXPECT_TRUE(flight_.until(60.0, [&](const TrajectoryPoint& point) {
    fastest = std::max(fastest, point.v_N.norm());
    return point.finished;
  }));
  EXPECT_LT(fastest, 3.0 + kRoundOff);
  EXPECT_LT((flight_.last.p_N - Vector3(20, 0, 0)).norm(), kRoundOff);
}

TEST_F(SmoothstepManagerTest, IsContinuousAndWithinItsLimitsOverAWholeRoute) {
  // One leg is limited by velocity, one by acceleration, one is a turn on the spot, one has its own speed.
  flight_.set({waypoint(1, Vector3(0, 0, -5)), waypoint(2, Vector3(-20, 0, -8), 2.0),
               waypoint(3, Vector3(-20, 0, -8), -2.0), waypoint(4, Vector3(-19.7, 0, -8), -2.0),
               waypoint(5, Vector3(-19.7, 10, -8))});
  flight_.route.waypoints[4].speed = 1.5;
  flight_.step();
  TrajectoryPoint before = flight_.last;
  double fastest_last_leg = 0.0;
  for (int i = 0; i < 60.0 / PerfectFlight::kDt && !flight_.last.finished; ++i) {
    const TrajectoryPoint& now = flight_.step();
    ASSERT_LE((now.p_N - before.p_N).norm(), 3.0 * PerfectFlight::kDt + kRoundOff);
    ASSERT_LE((now.v_N - before.v_N).norm(), 2.5 * PerfectFlight::kDt + kRoundOff);
    ASSERT_LE(std::abs(shortest_difference(now.heading, before.heading)),
              1.0 * PerfectFlight::kDt + kRoundOff);
    ASSERT_LE(now.a_N.norm(), 2.5 + kRoundOff);
    if (now.leg == 4) fastest_last_leg = std::max(fastest_last_leg, now.v_N.norm());
    before = now;
  }
  EXPECT_TRUE(flight_.last.finished);
  EXPECT_EQ(flight_.last.reached, 5u);
  EXPECT_NEAR(fastest_last_leg, 1.5, 1e-4) << "the peak of a sampled parabola";
}

TEST_F(SmoothstepManagerTest, TurnsTheShortWayThroughSouth) {
  flight_.estimate.heading = 3.0;
  flight_.follows = false;
  flight_.set({waypoint(1, Vector3::Zero(), -3.0)});
  flight_.fly(0.3);
  EXPECT_GT(flight_.last.heading_rate, 0.0);
  flight_.fly(5.0);
  EXPECT_NEAR(flight_.last.heading, -3.0, kRoundOff);
}

TEST_F(SmoothstepManagerTest, PassesALegOfNoLengthAndNoTurnAtOnce) {
  flight_.set({waypoint(1, Vector3::Zero()), waypoint(2, Vector3::Zero()), waypoint(3, Vector3(1, 0, 0))});
  flight_.step();
  flight_.step();
  EXPECT_EQ(flight_.last.leg, 2u);
  EXPECT_TRUE(flight_.last.p_N.allFinite());
  EXPECT_TRUE(flight_.until(5.0, [](const auto& p) { return p.finished; }));
}

TEST_F(SmoothstepManagerTest, WaitsAtAWaypointForAVehicleThatLags) {
  flight_.set({waypoint(1, Vector3(2, 0, 0)), waypoint(2, Vector3(4, 0, 0))});
  flight_.follows = false;
  flight_.fly(10.0);
  EXPECT_EQ(flight_.last.leg, 0u);
  EXPECT_EQ(flight_.last.p_N, Vector3(2, 0, 0));
  flight_.estimate.p_NB_N << 1.6, 0.0, 0.0;
  flight_.step();
  EXPECT_EQ(flight_.last.leg, 1u);
  EXPECT_EQ(flight_.last.p_N, Vector3(2, 0, 0)) << "the next leg begins at the waypoint";
}

TEST_F(SmoothstepManagerTest, SwitchesEarlyWhenToldTo) {
  manager_.set_params([] {
    SmoothstepManagerParams params;
    params.switch_early = true;
    params.waypoint_tolerance = 1.0;
    return params;
  }());
  flight_.set({waypoint(1, Vector3(10, 0, 0)), waypoint(2, Vector3(10, 10, 0))});
  ASSERT_TRUE(flight_.until(20.0, [](const auto& p) { return p.leg == 1; }));
  EXPECT_EQ(flight_.last.p_N, Vector3(10, 0, 0));
  EXPECT_EQ(flight_.last.v_N, Vector3(0, 0, 0));
  EXPECT_LT(flight_.estimate.stamp, std::chrono::milliseconds(6250)) << "before the leg of 6.25 s had ended";
}

TEST_F(SmoothstepManagerTest, ReproducesTheFirstLegOfTheReferenceWhenToldTo) {
  manager_.set_params([] {
    SmoothstepManagerParams params;
    params.reference_first_leg = true;
    return params;
  }());
  flight_.flight.phase = FlightPhase::kDisarmed;
  flight_.estimate.p_NB_N << 0.0, 0.0, -1.0;
  flight_.set({waypoint(1, Vector3(0, 0, -5), 1.0)});
  flight_.step();
  EXPECT_EQ(flight_.last.p_N, Vector3(0, 0, 0)) << "from the origin, wherever the vehicle is";
  flight_.fly(5.0);
  EXPECT_LT((flight_.last.p_N - Vector3(0, 0, -5)).norm(), kRoundOff) << "the clock runs on the ground";
}

TEST_F(SmoothstepManagerTest, FliesACyclicRouteAgainAndAgain) {
  flight_.set({waypoint(1, Vector3(1, 0, 0)), waypoint(2, Vector3(0, 0, 0))}, true);
  EXPECT_TRUE(flight_.until(60.0, [](const auto& p) { return p.reached == 7; }));
  EXPECT_EQ(flight_.last.leg, 1u);
  EXPECT_FALSE(flight_.last.finished);
}

TEST_F(SmoothstepManagerTest, HoldsForATimeAndThenFliesOn) {
  flight_.set({waypoint(1, Vector3(1, 0, 0), 0.0, WaypointKind::kHold), waypoint(2, Vector3(2, 0, 0))});
  flight_.route.waypoints[0].hold_time = 2.0;
  ASSERT_TRUE(flight_.until(10.0, [](const auto& p) { return p.holding; }));
  const Time began = flight_.estimate.stamp;
  ASSERT_TRUE(flight_.until(10.0, [](const auto& p) { return !p.holding; }));
  EXPECT_NEAR(seconds(flight_.estimate.stamp - began), 2.0, PerfectFlight::kDt / 2.0);
  EXPECT_EQ(flight_.last.leg, 1u);
}

TEST_F(SmoothstepManagerTest, HoldsIndefinitelyUntilReleased) {
  flight_.set({waypoint(1, Vector3(1, 0, 0), 0.0, WaypointKind::kHold), waypoint(2, Vector3(2, 0, 0))});
  flight_.route.waypoints[0].hold_indefinitely = true;
  ++flight_.route.released;  // a release before the hold is no release of it
  flight_.fly(100.0);
  EXPECT_TRUE(flight_.last.holding);
  ++flight_.route.released;
  flight_.step();
  EXPECT_EQ(flight_.last.leg, 1u);
}

TEST_F(SmoothstepManagerTest, AnnouncesALandingAtALandWaypoint) {
  flight_.set({waypoint(1, Vector3(1, 0, -5), 0.0, WaypointKind::kLand), waypoint(2, Vector3(9, 0, 0))});
  ASSERT_TRUE(flight_.until(20.0, [](const auto& p) { return p.landing; }));
  EXPECT_LT((flight_.last.p_N - Vector3(1, 0, -5)).norm(), kRoundOff);
  flight_.fly(5.0);
  EXPECT_TRUE(flight_.last.landing);
  EXPECT_EQ(flight_.last.leg, 0u);
}

TEST_F(SmoothstepManagerTest, StandsStillDuringAnOverrideAndLeavesFromWhereThePilotWent) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.fly(4.0);
  // WHEN the pilot takes the vehicle aside for ten seconds
  flight_.flight.fcu.rc_override = 1;
  flight_.estimate.v_NB_B.setZero();
  flight_.estimate.p_NB_N << 5.0, 30.0, -2.0;
  flight_.fly(10.0);
  EXPECT_EQ(flight_.last.p_N, Vector3(5, 30, -2));
  EXPECT_EQ(flight_.last.v_N, Vector3::Zero());
  EXPECT_TRUE(flight_.last.valid);
  // THEN the leg begins anew, there
  flight_.flight.fcu.rc_override = 0;
  flight_.step();
  EXPECT_EQ(flight_.last.p_N, Vector3(5, 30, -2));
  EXPECT_TRUE(flight_.until(40.0, [](const auto& p) { return p.finished; }));
  EXPECT_EQ(flight_.last.reached, 1u);
}

TEST_F(SmoothstepManagerTest, BringsAMovingVehicleToRestBeforeItLeaves) {
  flight_.set({waypoint(1, Vector3(0, 20, 0))});
  flight_.estimate.v_NB_B << 4.0, 0.0, 0.0;
  flight_.step();
  EXPECT_LT((flight_.last.v_N - Vector3(4, 0, 0)).norm(), kRoundOff);
  double hardest = 0.0;
  flight_.until(5.0, [&](const auto& p) {
    hardest = std::max(hardest, p.a_N.norm());
    return p.v_N.norm() == 0.0;
  });
  EXPECT_NEAR(hardest, 2.5, 1e-4);
  EXPECT_NEAR(flight_.last.p_N.x(), 0.5 * 4.0 * (1.5 * 4.0 / 2.5), kRoundOff) << "half the speed for 2.4 s";
}

TEST_F(SmoothstepManagerTest, RestartsTheRouteOnTheGround) {
  flight_.set({waypoint(1, Vector3(1, 0, 0)), waypoint(2, Vector3(2, 0, 0))});
  flight_.until(20.0, [](const auto& p) { return p.leg == 1; });
  flight_.flight.phase = FlightPhase::kDisarmed;
  flight_.step();
  EXPECT_EQ(flight_.last.leg, 0u);
  EXPECT_EQ(flight_.last.reached, 0u);
}

/// The reference must neither jump nor change its velocity faster than the limit, whatever happens to the
/// route.
void expect_smooth(PerfectFlight& flight, double seconds) {
  TrajectoryPoint before = flight.last;
  for (int i = 0; i < seconds / PerfectFlight::kDt; ++i) {
    const TrajectoryPoint& now = flight.step();
    ASSERT_LE((now.p_N - before.p_N).norm(), 3.0 * PerfectFlight::kDt + kRoundOff) << i;
    ASSERT_LE((now.v_N - before.v_N).norm(), 2.5 * PerfectFlight::kDt + kRoundOff) << i;
    before = now;
  }
}

TEST_F(SmoothstepManagerTest, HoldsOnTheSpotAndFliesOnWhenReleased) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.fly(5.0);
  ++flight_.route.holds;
  ++flight_.route.revision;
  expect_smooth(flight_, 5.0);
  EXPECT_TRUE(flight_.last.holding);
  EXPECT_EQ(flight_.last.v_N, Vector3::Zero());
  flight_.fly(50.0);
  EXPECT_TRUE(flight_.last.holding);
  ++flight_.route.released;
  expect_smooth(flight_, 15.0);
  EXPECT_TRUE(flight_.last.finished);
  EXPECT_EQ(flight_.last.reached, 1u);
}

TEST_F(SmoothstepManagerTest, HoldsOnTheSpotForATime) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.fly(5.0);
  flight_.route.hold_time = 3.0;
  ++flight_.route.holds;
  ++flight_.route.revision;
  ASSERT_TRUE(flight_.until(5.0, [](const auto& p) { return p.holding; }));
  const Time began = flight_.estimate.stamp;
  ASSERT_TRUE(flight_.until(5.0, [](const auto& p) { return !p.holding; }));
  EXPECT_NEAR(seconds(flight_.estimate.stamp - began), 3.0, PerfectFlight::kDt / 2.0);
}

TEST_F(SmoothstepManagerTest, KeepsFlyingItsLegWhenOtherWaypointsChange) {
  flight_.set({waypoint(1, Vector3(20, 0, 0)), waypoint(2, Vector3(0, 0, 0))});
  flight_.fly(5.0);
  const Vector3 v_N = flight_.last.v_N;
  flight_.set({waypoint(3, Vector3(-5, 0, 0)), waypoint(1, Vector3(20, 0, 0)), waypoint(2, Vector3(0, 0, 0)),
               waypoint(4, Vector3(5, 0, 0))});
  flight_.step();
  EXPECT_EQ(flight_.last.leg, 1u);
  EXPECT_NEAR(flight_.last.v_N.x(), v_N.x(), 2.5 * PerfectFlight::kDt);
  expect_smooth(flight_, 60.0);
  EXPECT_EQ(flight_.last.leg, 3u);
  EXPECT_TRUE(flight_.last.finished);
}

TEST_F(SmoothstepManagerTest, FliesToTheNextWaypointWhenTheOneAheadIsRemoved) {
  flight_.set(
      {waypoint(1, Vector3(20, 0, 0)), waypoint(2, Vector3(0, 10, 0)), waypoint(3, Vector3(0, 20, 0))});
  flight_.fly(5.0);
  flight_.set({waypoint(2, Vector3(0, 10, 0)), waypoint(3, Vector3(0, 20, 0))});
  expect_smooth(flight_, 12.0);
  EXPECT_EQ(flight_.last.reached, 1u);
  EXPECT_EQ(flight_.last.leg, 1u);
}

TEST_F(SmoothstepManagerTest, BeginsANewRouteAtItsFirstWaypoint) {
  flight_.set({waypoint(1, Vector3(5, 0, 0)), waypoint(2, Vector3(20, 0, 0))});
  flight_.until(20.0, [](const auto& p) { return p.leg == 1; });
  flight_.fly(1.5);
  flight_.set({waypoint(3, Vector3(0, 5, 0)), waypoint(4, Vector3(0, 0, 0))});
  expect_smooth(flight_, 1.0);
  EXPECT_EQ(flight_.last.leg, 0u);
  EXPECT_EQ(flight_.last.reached, 0u);
  expect_smooth(flight_, 20.0);
  EXPECT_TRUE(flight_.last.finished);
}

TEST_F(SmoothstepManagerTest, StopsAndStaysWhenTheRouteIsCleared) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.fly(5.0);
  flight_.set({});
  expect_smooth(flight_, 5.0);
  EXPECT_TRUE(flight_.last.valid);
  EXPECT_TRUE(flight_.last.finished);
  EXPECT_EQ(flight_.last.v_N, Vector3::Zero());
  flight_.set({waypoint(2, Vector3(0, 0, 0))});
  expect_smooth(flight_, 15.0);
  EXPECT_LT(flight_.last.p_N.norm(), kRoundOff);
}

TEST_F(SmoothstepManagerTest, FliesOnWhenAWaypointIsAddedAfterTheEnd) {
  flight_.set({waypoint(1, Vector3(1, 0, 0))});
  ASSERT_TRUE(flight_.until(9.0, [](const auto& p) { return p.finished; }));
  flight_.set({waypoint(1, Vector3(1, 0, 0)), waypoint(2, Vector3(2, 0, 0))});
  ASSERT_TRUE(flight_.until(9.0, [](const auto& p) { return p.reached == 2; }));
}

TEST_F(SmoothstepManagerTest, HoldsItsOutputBetweenItsPeriods) {
  manager_.set_period(std::chrono::milliseconds(20));
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  int changes = 0;
  for (int i = 0; i < 400; ++i) {
    const Time before = flight_.last.stamp;
    changes += flight_.step().stamp != before ? 1 : 0;
  }
  EXPECT_EQ(changes, 50);
}

TEST_F(SmoothstepManagerTest, KeepsItsLastPointWhenTheEstimateIsNotFinite) {
  flight_.set({waypoint(1, Vector3(20, 0, 0))});
  flight_.flight.fcu.rc_override = 1;
  flight_.step();
  flight_.estimate.p_NB_N.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(flight_.step().p_N.allFinite());
}

TEST_F(SmoothstepManagerTest, RemembersWhatWasFlownWhileThereIsNoEstimate) {
  // GIVEN a vehicle on its way to the second waypoint
  flight_.set({waypoint(1, Vector3(5, 0, 0)), waypoint(2, Vector3(20, 0, 0))});
  ASSERT_TRUE(flight_.until(20.0, [](const auto& p) { return p.leg == 1; }));
  // WHEN the estimate is lost
  flight_.estimate.health = Health::kLost;
  flight_.step();
  // THEN the point is not to be flown, but says how far the route has come
  EXPECT_FALSE(flight_.last.valid);
  EXPECT_EQ(flight_.last.reached, 1u);
  EXPECT_EQ(flight_.last.leg, 1u);
  // AND WHEN it is lost again after the end
  flight_.estimate.health = Health::kGood;
  ASSERT_TRUE(flight_.until(30.0, [](const auto& p) { return p.finished; }));
  flight_.estimate.health = Health::kLost;
  flight_.fly(1.0);
  EXPECT_TRUE(flight_.last.finished);
  EXPECT_EQ(flight_.last.reached, 2u);
}

TEST_F(SmoothstepManagerTest, TakesOverAFlightWithoutAJump) {
  flight_.set({waypoint(1, Vector3(5, 0, 0)), waypoint(2, Vector3(20, 0, 0))});
  flight_.until(20.0, [](const auto& p) { return p.leg == 1; });
  flight_.fly(3.0);
  Signals signals;
  signals.route = flight_.route;
  signals.trajectory = flight_.last;
  signals.flight = flight_.flight;
  SmoothstepManager successor;
  successor.take_over(signals);
  PerfectFlight second(successor);
  second.route = flight_.route;
  second.estimate = flight_.estimate;
  second.last = flight_.last;
  expect_smooth(second, 20.0);
  EXPECT_TRUE(second.last.finished);
  EXPECT_EQ(second.last.reached, 2u);
}

}  // namespace
}  // namespace ironbird::autopilot
