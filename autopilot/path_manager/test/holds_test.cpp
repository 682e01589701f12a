#include <gtest/gtest.h>

#include "autopilot/handover.hpp"
#include "autopilot/path_manager/smoothstep_manager.hpp"
#include "autopilot/path_manager/test/perfect_flight.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kForever = 60.0;  // s, long enough to see that a hold lasts

class HoldsTest : public ::testing::Test {
 protected:
  void hold_here(std::optional<double> duration = std::nullopt) {
    flight_.route.hold_time = duration;
    ++flight_.route.holds;
    ++flight_.route.revision;
  }

  /// Arrives at a waypoint where it holds for ten seconds, with another one after it, and stays for
  /// `seconds`.
  void hold_at_waypoint(double seconds) {
    flight_.set({waypoint(1, Vector3(2, 0, 0), 0.0, WaypointKind::kHold), waypoint(2, Vector3(4, 0, 0))});
    flight_.route.waypoints[0].hold_time = 10.0;
    ASSERT_TRUE(flight_.until(20.0, [](const auto& p) { return p.holding; }));
    flight_.fly(seconds);
    ASSERT_TRUE(flight_.last.holding);
  }

  /// Seconds until the vehicle is on its second leg.
  double time_to_leave(PerfectFlight& flight) {
    const Time began = flight.estimate.stamp;
    EXPECT_TRUE(flight.until(kForever, [](const auto& p) { return p.leg == 1; }));
    return seconds(flight.estimate.stamp - began);
  }

  /// A second manager that takes the flight over, as a swap does.
  void swap() {
    Signals signals;
    signals.route = flight_.route;
    signals.trajectory = flight_.last;
    signals.flight = flight_.flight;
    successor_.take_over(signals);
    second_.route = flight_.route;
    second_.estimate = flight_.estimate;
    second_.flight = flight_.flight;
    second_.last = flight_.last;
  }

  SmoothstepManager manager_;
  PerfectFlight flight_{manager_};
  SmoothstepManager successor_;
  PerfectFlight second_{successor_};
};

TEST_F(HoldsTest, BeginAnewWhenAskedForAgain) {
  flight_.set({waypoint(1, Vector3(40, 0, 0))});
  flight_.fly(5.0);
  hold_here(10.0);
  ASSERT_TRUE(flight_.until(9.0, [](const auto& p) { return p.holding; }));
  flight_.fly(9.0);
  hold_here(10.0);
  const Time again = flight_.estimate.stamp;
  ASSERT_TRUE(flight_.until(20.0, [](const auto& p) { return !p.holding; }));
  EXPECT_NEAR(seconds(flight_.estimate.stamp - again), 10.0, 1.5 * PerfectFlight::kDt);
}

TEST_F(HoldsTest, OnTheSpotLetAWaypointsHoldGoOnWhereItWas) {
  hold_at_waypoint(9.0);
  hold_here(1.0);
  EXPECT_NEAR(time_to_leave(flight_), 1.0 + 1.0, 4.0 * PerfectFlight::kDt);
  EXPECT_EQ(flight_.last.reached, 1u);
}

TEST_F(HoldsTest, AtAWaypointGoOnAfterAnOverride) {
  hold_at_waypoint(9.0);
  flight_.flight.fcu.rc_override = 1;
  flight_.fly(5.0);
  flight_.flight.fcu.rc_override = 0;
  EXPECT_NEAR(time_to_leave(flight_), 1.0, 4.0 * PerfectFlight::kDt);
}

TEST_F(HoldsTest, AreReleasedEvenWhileThePilotFlies) {
  flight_.set({waypoint(1, Vector3(40, 0, 0))});
  flight_.fly(5.0);
  hold_here();
  flight_.fly(5.0);
  flight_.flight.fcu.rc_override = 1;
  flight_.fly(1.0);
  ++flight_.route.released;
  flight_.fly(1.0);
  flight_.flight.fcu.rc_override = 0;
  EXPECT_TRUE(flight_.until(kForever, [](const auto& p) { return p.finished; }));
}

TEST_F(HoldsTest, AskedForDuringTakeOffBeginWhenTheCompanionFlies) {
  flight_.set({waypoint(1, Vector3(40, 0, -2))});
  flight_.flight.phase = FlightPhase::kDisarmed;
  flight_.fly(1.0);
  hold_here();
  flight_.flight.phase = FlightPhase::kTakeOff;
  flight_.fly(1.0);
  flight_.flight.phase = FlightPhase::kOffboard;
  flight_.fly(kForever);
  EXPECT_TRUE(flight_.last.holding);
  EXPECT_EQ(flight_.last.p_N, Vector3(0, 0, 0));
  ++flight_.route.released;
  EXPECT_TRUE(flight_.until(kForever, [](const auto& p) { return p.finished; }));
}

TEST_F(HoldsTest, AreForgottenWithTheFlight) {
  flight_.set({waypoint(1, Vector3(10, 0, 0))});
  flight_.fly(2.0);
  hold_here();
  flight_.fly(5.0);
  flight_.flight.phase = FlightPhase::kDisarmed;
  flight_.fly(1.0);
  flight_.flight.phase = FlightPhase::kOffboard;
  EXPECT_TRUE(flight_.until(kForever, [](const auto& p) { return p.finished; }));
}

TEST_F(HoldsTest, UntilReleasedOutliveASwap) {
  flight_.set({waypoint(1, Vector3(40, 0, 0))});
  flight_.fly(5.0);
  hold_here();
  flight_.fly(5.0);
  swap();
  second_.fly(kForever);
  EXPECT_TRUE(second_.last.holding);
  ++second_.route.released;
  EXPECT_TRUE(second_.until(kForever, [](const auto& p) { return p.finished; }));
  EXPECT_EQ(second_.last.reached, 1u);
}

TEST_F(HoldsTest, OnTheSpotLastNoLongerForASwap) {
  flight_.set({waypoint(1, Vector3(40, 0, 0))});
  flight_.fly(5.0);
  hold_here(10.0);
  ASSERT_TRUE(flight_.until(9.0, [](const auto& p) { return p.holding; }));
  flight_.fly(9.0);
  swap();
  const Time began = second_.estimate.stamp;
  ASSERT_TRUE(second_.until(20.0, [](const auto& p) { return !p.paused; }));
  EXPECT_NEAR(seconds(second_.estimate.stamp - began), 1.0, 4.0 * PerfectFlight::kDt);
}

TEST_F(HoldsTest, AtAWaypointLastNoLongerForASwap) {
  hold_at_waypoint(9.0);
  swap();
  EXPECT_NEAR(time_to_leave(second_), 1.0, 4.0 * PerfectFlight::kDt);
  EXPECT_EQ(second_.last.reached, 1u) << "counted once";
}

TEST_F(HoldsTest, SayWhatIsLeftOfThem) {
  hold_at_waypoint(4.0);
  EXPECT_TRUE(flight_.last.at_waypoint);
  EXPECT_FALSE(flight_.last.paused);
  ASSERT_TRUE(flight_.last.hold_left);
  EXPECT_NEAR(*flight_.last.hold_left, 6.0, 2.0 * PerfectFlight::kDt);
  hold_here();
  flight_.fly(1.0);
  EXPECT_TRUE(flight_.last.paused);
  EXPECT_FALSE(flight_.last.pause_left) << "until released";
  EXPECT_NEAR(*flight_.last.hold_left, 6.0, 3.0 * PerfectFlight::kDt) << "it stands meanwhile";
}

TEST_F(HoldsTest, PassWithTimeAlsoWhenNoEstimatesCome) {
  hold_at_waypoint(1.0);
  flight_.estimate.stamp += std::chrono::seconds(5);
  EXPECT_NEAR(time_to_leave(flight_), 4.0, 4.0 * PerfectFlight::kDt);
}

TEST(ReferenceTest, DoesNotJumpWhenEstimatesStopComing) {
  SmoothstepManager manager;
  PerfectFlight flight(manager);
  flight.set({waypoint(1, Vector3(60, 0, 0))});
  flight.fly(10.0);
  const TrajectoryPoint before = flight.last;
  ASSERT_GT(before.v_N.norm(), 1.5);
  flight.estimate.stamp += std::chrono::seconds(1);
  flight.step();
  const double longest = seconds(SequencedManager::kLongestStep);
  EXPECT_LE((flight.last.p_N - before.p_N).norm(), 3.0 * longest + kRoundOff);
  EXPECT_LE((flight.last.v_N - before.v_N).norm(), 2.5 * longest + kRoundOff);
}

TEST(ReferenceTest, MovesAlongWithEveryJumpSinceItsLastStep) {
  SmoothstepManager manager;
  manager.set_period(std::chrono::milliseconds(20));
  PerfectFlight flight(manager);
  flight.set({waypoint(1, Vector3(20, 0, 0))});
  flight.fly(3.0);
  const Vector3 before_N = flight.last.p_N;
  // WHEN the position jumps twice before the manager's next step
  for (const Vector3& jump_N : {Vector3(0.0, 30.0, 0.0), Vector3(0.0, -5.0, 0.0)}) {
    flight.estimate.p_NB_N += jump_N;
    flight.estimate.position_reset_sum_N += jump_N;
    ++flight.estimate.position_resets;
  }
  flight.follows = false;
  flight.fly(0.02);
  EXPECT_NEAR(flight.last.p_N.y() - before_N.y(), 25.0, 0.1);
}

TEST(ReferenceTest, LosesNoTimeOverAFewFramesThatAreMissing) {
  SmoothstepManager manager;
  PerfectFlight flight(manager);
  flight.set({waypoint(1, Vector3(60, 0, 0))});
  SmoothstepManager other_manager;
  PerfectFlight other(other_manager);
  other.set({waypoint(1, Vector3(60, 0, 0))});
  flight.fly(10.0);
  other.fly(9.98);
  other.estimate.stamp += std::chrono::microseconds(17500);
  other.step();
  EXPECT_LT((flight.last.p_N - other.last.p_N).norm(), kRoundOff);
}

}  // namespace
}  // namespace ironbird::autopilot
