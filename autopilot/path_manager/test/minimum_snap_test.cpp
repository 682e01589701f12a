#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "autopilot/path_manager/minimum_snap_manager.hpp"
#include "autopilot/path_manager/test/perfect_flight.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kFineStep = 1e-3;  // s
constexpr double kAnywhere = 1e3;   // m, an excursion that nothing reaches

MinimumSnapTrajectory example(const MotionLimits& limits) {
  MinimumSnapTrajectory trajectory;
  trajectory.begin(Vector3(0, 0, -5), 0.0);
  trajectory.add(Vector3(-20, 0, -8), 2.2, 10.0);
  trajectory.add(Vector3(-20, 20, -5), -2.5, 10.0);
  trajectory.add(Vector3(-18, 21, -5), -2.5, 0.8);
  trajectory.add(Vector3(0, 0, -5), 0.0, 10.0);
  trajectory.solve(limits, kAnywhere);
  return trajectory;
}

TEST(MinimumSnapTrajectoryTest, IsThePolynomialOfTheTextbookForASingleSegment) {
  // From rest to rest with velocity, acceleration and jerk zero: 35 t^4 - 84 t^5 + 70 t^6 - 20 t^7.
  MinimumSnapTrajectory trajectory;
  trajectory.begin(Vector3::Zero(), 0.0);
  trajectory.add(Vector3(10, 0, 0), 0.0, 3.0);
  trajectory.solve(MotionLimits{}, kAnywhere);
  for (double tau = 0.0; tau < 1.0; tau += 0.01) {
    const double t4 = std::pow(tau, 4);
    const double expected = t4 * (35.0 + tau * (-84.0 + tau * (70.0 - 20.0 * tau)));
    EXPECT_NEAR(trajectory.evaluate(tau * trajectory.duration()).p_N.x(), 10.0 * expected, kRoundOff);
  }
}

TEST(MinimumSnapTrajectoryTest, PassesThroughItsPlacesAndRestsAtItsEnds) {
  const MinimumSnapTrajectory trajectory = example(MotionLimits{});
  EXPECT_LT((trajectory.evaluate(trajectory.end_of(0)).p_N - Vector3(-20, 0, -8)).norm(), kRoundOff);
  EXPECT_LT((trajectory.evaluate(trajectory.end_of(1)).p_N - Vector3(-20, 20, -5)).norm(), kRoundOff);
  EXPECT_NEAR(trajectory.evaluate(trajectory.end_of(1)).heading, -2.5, kRoundOff);
  for (const double t : {0.0, trajectory.duration() * (1.0 - 1e-12), trajectory.duration() + 5.0}) {
    EXPECT_LT(trajectory.evaluate(t).v_N.norm(), kRoundOff);
    EXPECT_LT(trajectory.evaluate(t).a_N.norm(), kRoundOff);
  }
  EXPECT_TRUE(trajectory.evaluate(trajectory.duration()).ended);
}

/// Derivative of order `n` of the acceleration, found by differences on one side of `t`, m/s^(2+n).
Vector3 one_sided(const MinimumSnapTrajectory& trajectory, double t, int n, double h) {
  const auto a = [&](double at) { return trajectory.evaluate(at).a_N; };
  if (n == 0) return a(t);
  return (one_sided(trajectory, t + h, n - 1, h) - one_sided(trajectory, t, n - 1, h)) / h;
}

TEST(MinimumSnapTrajectoryTest, IsContinuousUpToTheSixthDerivativeAtItsPlaces) {
  const MinimumSnapTrajectory trajectory = example(MotionLimits{});
  const double h = 0.01;  // s
  for (std::size_t i = 0; i + 1 < trajectory.legs(); ++i) {
    const double t = trajectory.end_of(i);
    for (int n = 0; n <= 4; ++n) {
      // One-sided differences are off by about n h/2 times the next derivative, and by rounding over h^n.
      const double scale =
          one_sided(trajectory, t, n + 1, h).norm() + one_sided(trajectory, t, n + 1, -h).norm();
      const double tolerance = (n + 1) * h * (scale + 0.02) + 1e-13 / std::pow(h, n);
      const double gap =
          (one_sided(trajectory, t + 1e-9, n, h) - one_sided(trajectory, t - 1e-9, n, -h)).norm();
      EXPECT_LT(gap, tolerance) << "place " << i << ", derivative " << n + 2;
    }
  }
}

TEST(MinimumSnapTrajectoryTest, HasDerivativesThatAgreeWithCentralDifferences) {
  const MinimumSnapTrajectory trajectory = example(MotionLimits{});
  const double h = 1e-4;
  for (double t = 0.05; t < trajectory.duration() - 0.05; t += 0.0371) {
    const MotionPoint now = trajectory.evaluate(t);
    const MotionPoint before = trajectory.evaluate(t - h);
    const MotionPoint after = trajectory.evaluate(t + h);
    EXPECT_LT((now.v_N - (after.p_N - before.p_N) / (2.0 * h)).norm(), 1e-6);
    EXPECT_LT((now.a_N - (after.v_N - before.v_N) / (2.0 * h)).norm(), 1e-6);
    EXPECT_NEAR(now.heading_rate, shortest_difference(after.heading, before.heading) / (2.0 * h), 1e-6);
    EXPECT_NEAR(now.heading_acceleration, (after.heading_rate - before.heading_rate) / (2.0 * h), 1e-6);
  }
}

double snap_cost(const MinimumSnapTrajectory& trajectory) {
  const double h = 2e-3;
  double cost = 0.0;
  for (double t = 3.0 * h; t < trajectory.duration() - 3.0 * h; t += h) {
    const Vector3 snap =
        (trajectory.evaluate(t + h).a_N - 2.0 * trajectory.evaluate(t).a_N + trajectory.evaluate(t - h).a_N) /
        (h * h);
    cost += snap.squaredNorm() * h;
  }
  return cost;
}

TEST(MinimumSnapTrajectoryTest, CostsLessSnapThanStoppingAtEachPlace) {
  // GIVEN one trajectory through a place on a straight line, and two that stop there, of the same total
  // duration
  MinimumSnapTrajectory through;
  through.begin(Vector3::Zero(), 0.0);
  through.add(Vector3(10, 0, 0), 0.0, 3.0);
  through.add(Vector3(20, 0, 0), 0.0, 3.0);
  through.solve(MotionLimits{}, kAnywhere);
  // THEN its cost is that of the optimum: rest-to-rest through the middle of a symmetric way is the single
  // polynomial 35 t^4 - ..., whose snap cost is 100800 d^2/T^7.
  const double optimum = 100800.0 * 400.0 / std::pow(through.duration(), 7);
  EXPECT_NEAR(snap_cost(through) / optimum, 1.0, 0.02) << "numerical second differences";
}

struct LimitCase {
  const char* name;
  MotionLimits limits;
};

class MinimumSnapLimitsTest : public ::testing::TestWithParam<LimitCase> {};

TEST_P(MinimumSnapLimitsTest, AreMetButNeverExceeded) {
  const MotionLimits& limits = GetParam().limits;
  const MinimumSnapTrajectory trajectory = example(limits);
  double nearest = 0.0;
  const double most_jerk = limits.max_acceleration / limits.rise_time;
  const double most_heading_jerk = limits.max_heading_acceleration / limits.rise_time;
  MotionPoint last = trajectory.evaluate(0.0);
  for (double t = 0.0; t <= trajectory.duration(); t += kFineStep) {
    const MotionPoint point = trajectory.evaluate(t);
    const double jerk = (point.a_N - last.a_N).norm() / kFineStep;
    const double heading_jerk = std::abs(point.heading_acceleration - last.heading_acceleration) / kFineStep;
    last = point;
    ASSERT_LE(jerk, most_jerk);
    ASSERT_LE(heading_jerk, most_heading_jerk);
    nearest = std::max({nearest, jerk / most_jerk, heading_jerk / most_heading_jerk});
    ASSERT_LE(point.v_N.norm(), limits.max_velocity);
    ASSERT_LE(point.a_N.norm(), limits.max_acceleration);
    ASSERT_LE(std::abs(point.heading_rate), limits.max_heading_rate);
    ASSERT_LE(std::abs(point.heading_acceleration), limits.max_heading_acceleration);
    if (point.passed == 2) {
      ASSERT_LE(point.v_N.norm(), 0.8) << "the speed of its own leg";
      nearest = std::max(nearest, point.v_N.norm() / 0.8);
    }
    nearest =
        std::max({nearest, point.v_N.norm() / limits.max_velocity, point.a_N.norm() / limits.max_acceleration,
                  std::abs(point.heading_rate) / limits.max_heading_rate,
                  std::abs(point.heading_acceleration) / limits.max_heading_acceleration});
  }
  EXPECT_GT(nearest, 0.98);
}

INSTANTIATE_TEST_SUITE_P(Cases, MinimumSnapLimitsTest,
                         ::testing::Values(LimitCase{"Usual", {}}, LimitCase{"Slow", {0.2, 2.0, 1.0, 2.0}},
                                           LimitCase{"Soft", {50.0, 0.05, 1e3, 1e6}},
                                           LimitCase{"SlowTurns", {50.0, 50.0, 0.1, 2.0}},
                                           LimitCase{"SoftTurns", {50.0, 50.0, 50.0, 0.01}},
                                           LimitCase{"Gentle", {50.0, 2.5, 50.0, 2.0, 3.0}},
                                           LimitCase{"GentleTurns", {50.0, 50.0, 50.0, 2.0, 3.0}}),
                         [](const auto& case_) { return case_.param.name; });

TEST(MinimumSnapTrajectoryTest, SolvesAsManyLegsAsItHolds) {
  MinimumSnapTrajectory trajectory;
  trajectory.begin(Vector3::Zero(), 0.0);
  for (std::size_t i = 1; i <= MinimumSnapTrajectory::kMostLegs; ++i) {
    const double angle = 0.7 * static_cast<double>(i);
    const double radius = i % 5 == 0 ? 0.5 : 20.0;  // very unequal legs
    trajectory.add(Vector3(radius * std::cos(angle), radius * std::sin(angle), -5.0), angle, 3.0);
  }
  trajectory.solve(MotionLimits{}, kAnywhere);
  MotionPoint before = trajectory.evaluate(0.0);
  for (double t = 0.0; t < trajectory.duration(); t += 0.01) {
    const MotionPoint now = trajectory.evaluate(t);
    ASSERT_LE(now.v_N.norm(), 3.0);
    ASSERT_LE((now.p_N - before.p_N).norm(), 3.0 * 0.01 + kRoundOff);
    before = now;
  }
}

struct ExcursionCase {
  const char* name;
  std::vector<Vector3> places_N;
  double most;     // m
  double longest;  // s, of the whole
};

class MinimumSnapExcursionTest : public ::testing::TestWithParam<ExcursionCase> {};

/// Distance of `p_N` from the straight way between two places, m.
double distance_from(const Vector3& p_N, const Vector3& from_N, const Vector3& to_N) {
  const Vector3 way_N = to_N - from_N;
  const double share = std::clamp((p_N - from_N).dot(way_N) / way_N.squaredNorm(), 0.0, 1.0);
  return (p_N - from_N - share * way_N).norm();
}

TEST_P(MinimumSnapExcursionTest, StaysWithinBoundsOverLegsOfUnequalLength) {
  const std::vector<Vector3>& places_N = GetParam().places_N;
  double total = 0.0;
  for (std::size_t first = 0; first + 1 < places_N.size();) {
    MinimumSnapTrajectory trajectory;
    trajectory.begin(places_N[first], 0.0);
    for (std::size_t i = first + 1; i < places_N.size(); ++i) trajectory.add(places_N[i], 0.0, 10.0);
    const std::size_t legs = trajectory.solve(MotionLimits{}, GetParam().most);
    ASSERT_GE(legs, 1u);
    ASSERT_EQ(legs, trajectory.legs());
    for (double t = 0.0; t < trajectory.duration(); t += 0.01) {
      const MotionPoint point = trajectory.evaluate(t);
      const std::size_t leg = first + point.passed;
      ASSERT_LE(distance_from(point.p_N, places_N[leg], places_N[leg + 1]), 1.01 * GetParam().most)
          << "between samples the path bends little";
    }
    total += trajectory.duration();
    first += legs;
  }
  EXPECT_LT(total, GetParam().longest);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MinimumSnapExcursionTest,
    ::testing::Values(
        ExcursionCase{"ThePapersMission", {{0, 0, -2}, {0, 0, -5}, {-20, 0, -8}, {-20, 20, -5}}, 1.0, 30.0},
        ExcursionCase{"LowOverTheGround", {{0, 0, -1}, {2, 0, -1}, {60, 0, -1.5}, {62, 0, -20}}, 0.9, 60.0},
        ExcursionCase{"FarAway", {{0, 0, -2}, {1, 0, -2}, {100, 0, -2}, {100, 10, -12}}, 1.0, 90.0},
        ExcursionCase{
            "NearlyTheSamePlace", {{0, 0, -5}, {20, 0, -5}, {20.002, 0, -5}, {20, 20, -5}}, 1.0, 30.0},
        ExcursionCase{"NarrowTube", {{0, 0, -5}, {20, 0, -5}, {0, 1, -5}, {20, 2, -5}}, 0.05, 60.0}),
    [](const auto& case_) { return case_.param.name; });

TEST(MinimumSnapTrajectoryTest, FliesASquareThroughItsCornersInsteadOfStoppingThere) {
  MinimumSnapTrajectory trajectory;
  trajectory.begin(Vector3(0, 0, -5), 0.0);
  trajectory.add(Vector3(10, 0, -5), 0.0, 3.0);
  trajectory.add(Vector3(10, 10, -5), 0.0, 3.0);
  trajectory.add(Vector3(0, 10, -5), 0.0, 3.0);
  EXPECT_EQ(trajectory.solve(MotionLimits{}, 1.0), 3u);
  EXPECT_GT(trajectory.evaluate(trajectory.end_of(0)).v_N.norm(), 0.5);
}

class MinimumSnapManagerTest : public ::testing::Test {
 protected:
  MinimumSnapManager manager_;
  PerfectFlight flight_{manager_};
};

TEST_F(MinimumSnapManagerTest, FliesThroughWaypointsWithoutStoppingAndCountsThem) {
  flight_.set(
      {waypoint(1, Vector3(10, 0, 0)), waypoint(2, Vector3(10, 10, 0)), waypoint(3, Vector3(0, 10, 0))});
  std::uint32_t seen = 0;
  double slowest = 1e9;
  ASSERT_TRUE(flight_.until(60.0, [&](const TrajectoryPoint& p) {
    if (p.reached != seen && !p.finished) slowest = std::min(slowest, p.v_N.norm());
    seen = p.reached;
    return p.finished;
  }));
  EXPECT_EQ(seen, 3u);
  EXPECT_GT(slowest, 0.3);
  EXPECT_LT((flight_.last.p_N - Vector3(0, 10, 0)).norm(), kRoundOff);
}

TEST_F(MinimumSnapManagerTest, FliesThePapersMissionAboveTheGroundAndNearItsLegs) {
  flight_.estimate.p_NB_N << 0.0, 0.0, -2.0;
  flight_.set(
      {waypoint(1, Vector3(0, 0, -5)), waypoint(2, Vector3(-20, 0, -8)), waypoint(3, Vector3(-20, 20, -5))});
  double lowest = 10.0;
  double highest = 0.0;
  ASSERT_TRUE(flight_.until(40.0, [&](const TrajectoryPoint& p) {
    lowest = std::min(lowest, -p.p_N.z());
    highest = std::max(highest, -p.p_N.z());
    return p.finished;
  }));
  EXPECT_GT(lowest, 1.0) << "m, where the start is at 2";
  EXPECT_LT(highest, 9.0) << "m, where the highest waypoint is at 8";
}

TEST_F(MinimumSnapManagerTest, StopsWhereFlyingThroughWouldStrayTooFar) {
  flight_.set(
      {waypoint(1, Vector3(1, 0, 0)), waypoint(2, Vector3(100, 0, 0)), waypoint(3, Vector3(100, 10, -10))});
  ASSERT_TRUE(flight_.until(60.0, [](const auto& p) { return p.leg == 1; }));
  EXPECT_LT(flight_.last.v_N.norm(), kRoundOff);
  ASSERT_TRUE(flight_.until(150.0, [](const auto& p) { return p.finished; }));
  EXPECT_EQ(flight_.last.reached, 3u);
}

TEST_F(MinimumSnapManagerTest, StopsAtHoldsLandingsAndRepeatedPlaces) {
  flight_.set({waypoint(1, Vector3(5, 0, 0)), waypoint(2, Vector3(5, 5, 0), 0.0, WaypointKind::kHold),
               waypoint(3, Vector3(0, 5, 0)), waypoint(4, Vector3(0, 5, 0), 1.5),
               waypoint(5, Vector3(0, 0, 0), 1.5, WaypointKind::kLand)});
  flight_.route.waypoints[1].hold_time = 1.0;
  ASSERT_TRUE(flight_.until(30.0, [](const auto& p) { return p.holding; }));
  EXPECT_EQ(flight_.last.leg, 1u);
  EXPECT_LT(flight_.last.v_N.norm(), kRoundOff);
  ASSERT_TRUE(flight_.until(30.0, [](const auto& p) { return p.leg == 3; }));
  EXPECT_LT(flight_.last.v_N.norm(), kRoundOff) << "it turns on the spot";
  ASSERT_TRUE(flight_.until(30.0, [](const auto& p) { return p.landing; }));
  EXPECT_EQ(flight_.last.reached, 5u);
}

TEST_F(MinimumSnapManagerTest, BrakesAndPlansAnewWhenTheRouteChanges) {
  flight_.set({waypoint(1, Vector3(10, 0, 0)), waypoint(2, Vector3(10, 10, 0))});
  flight_.fly(3.0);
  TrajectoryPoint before = flight_.last;
  flight_.set({waypoint(1, Vector3(10, 0, 0)), waypoint(3, Vector3(20, 0, 0))});
  ASSERT_TRUE(flight_.until(40.0, [&](const TrajectoryPoint& p) {
    EXPECT_LE((p.v_N - before.v_N).norm(), 2.5 * PerfectFlight::kDt + kRoundOff);
    EXPECT_LE((p.p_N - before.p_N).norm(), 3.0 * PerfectFlight::kDt + kRoundOff);
    before = p;
    return p.finished;
  }));
  EXPECT_LT((flight_.last.p_N - Vector3(20, 0, 0)).norm(), kRoundOff);
  EXPECT_EQ(flight_.last.reached, 2u);
}

TEST_F(MinimumSnapManagerTest, StopsAtTheLastWaypointOfACyclicRouteAndFliesItAgain) {
  flight_.set({waypoint(1, Vector3(3, 0, 0)), waypoint(2, Vector3(3, 3, 0)), waypoint(3, Vector3(0, 0, 0))},
              true);
  EXPECT_TRUE(flight_.until(60.0, [](const auto& p) { return p.reached == 6; }));
}

TEST_F(MinimumSnapManagerTest, FliesARouteThatIsLongerThanOneTrajectory) {
  std::vector<Waypoint> waypoints;
  for (std::uint32_t i = 1; i <= 100; ++i) waypoints.push_back(waypoint(i, Vector3(i % 2, 0.5 * i, 0)));
  flight_.set(waypoints);
  EXPECT_TRUE(flight_.until(600.0, [](const auto& p) { return p.finished; }));
  EXPECT_EQ(flight_.last.reached, 100u);
}

}  // namespace
}  // namespace ironbird::autopilot
