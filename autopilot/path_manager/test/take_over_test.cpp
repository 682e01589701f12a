#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "autopilot/handover.hpp"
#include "autopilot/path_manager/minimum_snap_manager.hpp"
#include "autopilot/path_manager/smoothstep_manager.hpp"
#include "autopilot/path_manager/test/perfect_flight.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kRound = 1e-9;
constexpr MotionLimits kLimits;
// With a margin for a brake that begins with an acceleration: its jerk is bounded at its ends only.
constexpr double kSteepest = 1.2 * kLimits.max_acceleration / kLimits.rise_time;                 // m/s^3
constexpr double kSteepestHeading = 1.2 * kLimits.max_heading_acceleration / kLimits.rise_time;  // rad/s^3

std::unique_ptr<PathManager> make(bool curves) {
  if (curves) return std::make_unique<MinimumSnapManager>();
  return std::make_unique<SmoothstepManager>();
}

std::vector<Waypoint> mission() {
  return {waypoint(1, {15, 0, -6}, 0.0), waypoint(2, {15, 15, -8}, 2.5), waypoint(3, {0, 15, -6}, -2.0),
          waypoint(4, {0, 0, -3}, 0.0)};
}

/// The reference goes from one point to the next within what a motion without a jump may do in a step.
void expect_no_jump(const TrajectoryPoint& before, const TrajectoryPoint& now, double at) {
  const double dt = PerfectFlight::kDt;
  const double rise = dt * kSteepest;
  EXPECT_LT((now.a_N - before.a_N).norm(), rise) << "at " << at << " s";
  EXPECT_LT((now.v_N - before.v_N - 0.5 * dt * (before.a_N + now.a_N)).norm(), dt * rise + kRound) << at;
  EXPECT_LT((now.p_N - before.p_N - 0.5 * dt * (before.v_N + now.v_N)).norm(), dt * dt * rise + kRound) << at;
  EXPECT_LT(std::abs(now.heading_acceleration - before.heading_acceleration), dt * kSteepestHeading) << at;
}

class ShortLegTest : public ::testing::TestWithParam<bool> {};

TEST_P(ShortLegTest, NeverChangesTheAccelerationFasterThanTheVehicleCanLean) {
  for (const double length : {0.003, 0.03, 0.3, 3.0}) {
    for (const double turn : {0.0, 0.02, 0.4}) {
      const std::unique_ptr<PathManager> manager = make(GetParam());
      PerfectFlight flight(*manager);
      flight.set({waypoint(1, {length, 0, 0}, turn), waypoint(2, {length, length, 0}, 0.0)});
      TrajectoryPoint last = flight.step();
      flight.until(15.0, [&](const TrajectoryPoint& now) {
        expect_no_jump(last, now, seconds(now.stamp));
        last = now;
        return HasFailure() || now.finished;
      });
      EXPECT_TRUE(last.finished) << length << " m, " << turn << " rad";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Managers, ShortLegTest, ::testing::Values(false, true),
                         [](const auto& curves) { return curves.param ? "Curves" : "Legs"; });

struct Swap {
  const char* name;
  bool from_curves;
  bool to_curves;
};

class TakeOverTest : public ::testing::TestWithParam<Swap> {};

TEST_P(TakeOverTest, GoesOnWithPositionVelocityAndAccelerationWheneverItComes) {
  const std::unique_ptr<PathManager> first = make(GetParam().from_curves);
  PerfectFlight before(*first);
  before.set(mission());
  for (double at = 0.1; at < 45.0; at += 0.1) {
    before.fly(0.1);
    Signals signals;
    signals.route = before.route;
    signals.estimate = before.estimate;
    signals.flight = before.flight;
    signals.trajectory = before.last;
    const std::unique_ptr<PathManager> second = make(GetParam().to_curves);
    second->take_over(signals);
    PerfectFlight after(*second);
    after.route = before.route;
    after.estimate = before.estimate;
    TrajectoryPoint last = before.last;
    after.until(3.0, [&](const TrajectoryPoint& now) {
      expect_no_jump(last, now, at);
      last = now;
      return HasFailure();
    });
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(Managers, TakeOverTest,
                         ::testing::Values(Swap{"LegsAfterLegs", false, false},
                                           Swap{"CurvesAfterLegs", false, true},
                                           Swap{"LegsAfterCurves", true, false},
                                           Swap{"CurvesAfterCurves", true, true}),
                         [](const auto& case_) { return case_.param.name; });

class HoldTest : public ::testing::TestWithParam<bool> {};

TEST_P(HoldTest, BrakesWithoutAJumpWheneverItIsAskedFor) {
  constexpr double kBetween = 0.3;  // s; each needs a flight of its own, as a manager cannot be copied
  for (double at = 0.1; at < 45.0; at += kBetween) {
    const std::unique_ptr<PathManager> manager = make(GetParam());
    PerfectFlight flight(*manager);
    flight.set(mission());
    flight.fly(at);
    ++flight.route.holds;
    TrajectoryPoint last = flight.last;
    flight.until(3.0, [&](const TrajectoryPoint& now) {
      expect_no_jump(last, now, at);
      last = now;
      return HasFailure();
    });
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(Managers, HoldTest, ::testing::Values(false, true),
                         [](const auto& curves) { return curves.param ? "Curves" : "Legs"; });

TEST(BrakeTest, ExceedsNeitherTheLimitNorWhatItBeganWith) {
  const MotionLimits limits;
  for (const double v0 : {0.0, 0.05, 0.5, 3.0, 10.0}) {
    for (const double a0 : {0.0, 0.3, 1.5, 2.5, 4.0}) {
      for (double angle = 0.0; angle < 3.2; angle += 0.4) {
        MotionPoint from;
        from.v_N << v0, 0.0, 0.0;
        from.a_N << a0 * std::cos(angle), a0 * std::sin(angle), 0.0;
        const Brake brake(from, limits);
        const double most = std::max(limits.max_acceleration, a0);
        for (double tau = 0.0; tau <= 1.0; tau += 0.01) {
          ASSERT_LE(brake.evaluate(tau * brake.duration()).a_N.norm(), most + kRound)
              << v0 << " m/s, " << a0 << " m/s^2, " << angle;
        }
        const MotionPoint end = brake.evaluate(brake.duration());
        EXPECT_TRUE(end.ended);
        EXPECT_LT(end.v_N.norm() + end.a_N.norm(), kRound);
      }
    }
  }
}

}  // namespace
}  // namespace ironbird::autopilot
