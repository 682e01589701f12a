#include "scenarios/requirements/metrics.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "scenarios/requirements/attitude.hpp"

namespace ironbird::scenarios {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr double kRoundOff = 1e-9;
constexpr double kDegree = std::numbers::pi / 180.0;

autopilot::Route route_through(const std::vector<Vector3d>& points, bool cyclic = false) {
  autopilot::Route route;
  route.cyclic = cyclic;
  for (const Vector3d& p : points) {
    autopilot::Waypoint waypoint;
    waypoint.p_N = p;
    route.waypoints.push_back(waypoint);
  }
  return route;
}

/// An airborne vehicle under the companion's command, between its first and its last waypoint.
class RunMetricsTest : public ::testing::Test {
 protected:
  RunMetricsTest() {
    signals_.flight.phase = autopilot::FlightPhase::kOffboard;
    signals_.flight.fcu.armed = true;
    signals_.trajectory.valid = true;
    signals_.trajectory.reached = 1;
    signals_.route = route_through({{0, 0, -5}, {100, 0, -5}, {100, 100, -5}});
  }
  /// Observes `ticks` ticks of 2.5 ms, with `set` called before each. @return a metric by name
  template <class Set>
  void fly(int ticks, Set set) {
    for (int i = 0; i < ticks; ++i) {
      set(i);
      metrics_.observe(i * 2500us);
    }
  }
  double metric(const std::string& name) const {
    for (const Metric& found : metrics_.results()) {
      if (found.name == name) return found.value;
    }
    ADD_FAILURE() << "no metric " << name;
    return 0.0;
  }

  simulator::Truth truth_;
  autopilot::Signals signals_;
  RunMetrics metrics_{{&truth_, &signals_}};
};

TEST(PolylineTest, FindsTheNearestPointOfAllSegments) {
  const autopilot::Route route = route_through({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}});
  EXPECT_TRUE(to_polyline({5, 2, 0}, route).isApprox(Vector3d(0, -2, 0)));
  EXPECT_TRUE(to_polyline({12, 7, 3}, route).isApprox(Vector3d(-2, 0, -3)));
  EXPECT_TRUE(to_polyline({-3, 4, 0}, route).isApprox(Vector3d(3, -4, 0)));
  // Nearer to the closing leg than to any other.
  EXPECT_NEAR(to_polyline({3, 6, 0}, route_through({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, true)).norm(),
              3.0 / std::sqrt(2.0), kRoundOff);
}

TEST(PolylineTest, HoldsForOnePointTwoEqualOnesAndNone) {
  EXPECT_TRUE(to_polyline({1, 1, 1}, route_through({})).isZero());
  EXPECT_TRUE(to_polyline({1, 0, 0}, route_through({{0, 0, 0}})).isApprox(Vector3d(-1, 0, 0)));
  EXPECT_TRUE(to_polyline({1, 0, 0}, route_through({{0, 0, 0}, {0, 0, 0}})).isApprox(Vector3d(-1, 0, 0)));
}

TEST_F(RunMetricsTest, PathErrorIsTheOffsetFromTheLine) {
  fly(400, [&](int i) {
    signals_.estimate.p_NB_N = {i * 0.1, 0.3, -5.4};
    truth_.p_NB_N = {i * 0.1, -0.6, -5.0};
  });
  EXPECT_NEAR(metric("path_rms_north_m"), 0.0, kRoundOff);
  EXPECT_NEAR(metric("path_rms_east_m"), 0.3, kRoundOff);
  EXPECT_NEAR(metric("path_rms_down_m"), 0.4, kRoundOff);
  EXPECT_NEAR(metric("path_rms_total_m"), 0.5, kRoundOff);
  EXPECT_NEAR(metric("true_path_rms_total_m"), 0.6, kRoundOff);
}

TEST_F(RunMetricsTest, PathErrorCountsFromTheFirstWaypointToTheLast) {
  fly(3000, [&](int i) {
    signals_.trajectory.reached = i < 1000 ? 0 : i < 2000 ? 1 : 3;
    signals_.estimate.p_NB_N = {50.0, i >= 1000 && i < 2000 ? 0.2 : 9.0, -5.0};
  });
  EXPECT_NEAR(metric("path_rms_total_m"), 0.2, kRoundOff);
}

TEST_F(RunMetricsTest, PathErrorOfACyclicRouteCountsUntilTheEnd) {
  signals_.route.cyclic = true;
  fly(800, [&](int i) {
    signals_.trajectory.reached = i < 400 ? 1 : 7;
    signals_.estimate.p_NB_N = {50.0, i < 400 ? 0.0 : 0.5, -5.0};
  });
  EXPECT_NEAR(metric("path_rms_total_m"), 0.5 / std::sqrt(2.0), kRoundOff);
}

TEST_F(RunMetricsTest, TrackingErrorIsTakenAtTheSameTime) {
  fly(400, [&](int i) {
    signals_.trajectory.p_N = {i * 0.1, 0.0, -5.0};
    signals_.estimate.p_NB_N = {i * 0.1 - 1.5, 0.0, -5.0};
    truth_.p_NB_N = {i * 0.1 - 2.0, 0.0, -5.0};
  });
  EXPECT_NEAR(metric("tracking_rms_north_m"), 1.5, kRoundOff);
  EXPECT_NEAR(metric("tracking_rms_total_m"), 1.5, kRoundOff);
  EXPECT_NEAR(metric("true_tracking_rms_total_m"), 2.0, kRoundOff);
}

TEST_F(RunMetricsTest, RootMeanSquareOfASineIsItsAmplitudeOverRootTwo) {
  // 50 samples a second, whole periods.
  fly(4000,
      [&](int i) { signals_.estimate.p_NB_N.x() = 2.0 * std::sin(2.0 * std::numbers::pi * i * 0.0025); });
  EXPECT_NEAR(metric("estimate_north_rms_m"), std::sqrt(2.0), kRoundOff);
  EXPECT_NEAR(metric("estimate_horizontal_rms_m"), std::sqrt(2.0), kRoundOff);
}

TEST_F(RunMetricsTest, PositionErrorsCombineByTheirSquares) {
  fly(100, [&](int) { signals_.estimate.p_NB_N = {1.0, 2.0, 2.0}; });
  EXPECT_NEAR(metric("estimate_position_rms_m"), 3.0, kRoundOff);
  EXPECT_NEAR(metric("estimate_horizontal_rms_m"), 2.0, kRoundOff);  // the worse axis
  EXPECT_NEAR(metric("estimate_down_rms_m"), 2.0, kRoundOff);
}

TEST_F(RunMetricsTest, ATiltThatIsNotANumberIsNotPassedOver) {
  fly(100, [&](int i) {
    if (i == 50) truth_.q_NB.x() = std::numeric_limits<double>::quiet_NaN();
    if (i == 60) truth_.q_NB.setIdentity();
  });
  EXPECT_TRUE(std::isnan(metric("max_tilt_deg")));
}

TEST_F(RunMetricsTest, VelocityErrorIsInBodyAxes) {
  truth_.q_NB = Eigen::AngleAxisd(90.0 * kDegree, Vector3d::UnitZ());
  truth_.v_NB_N = {0.0, 4.0, 0.0};  // east: forward for the body
  signals_.estimate.q_NB = truth_.q_NB;
  signals_.estimate.v_NB_B = {4.3, 0.4, 0.0};
  fly(100, [](int) {});
  EXPECT_NEAR(metric("estimate_velocity_forward_rms_mps"), 0.3, kRoundOff);
  EXPECT_NEAR(metric("estimate_velocity_right_rms_mps"), 0.4, kRoundOff);
  EXPECT_NEAR(metric("estimate_velocity_rms_mps"), 0.4, kRoundOff);  // the worst axis
  EXPECT_NEAR(metric("estimate_velocity_total_rms_mps"), 0.5, kRoundOff);
  EXPECT_NEAR(metric("max_speed_mps"), 4.0, kRoundOff);
}

TEST_F(RunMetricsTest, AttitudeErrorsWrapAndNameTheWorse) {
  truth_.q_NB = Eigen::AngleAxisd(179.0 * kDegree, Vector3d::UnitZ());
  signals_.estimate.q_NB = Eigen::AngleAxisd(-178.0 * kDegree, Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(1.0 * kDegree, Vector3d::UnitY()) *
                           Eigen::AngleAxisd(-2.0 * kDegree, Vector3d::UnitX());
  fly(100, [](int) {});
  EXPECT_NEAR(metric("estimate_heading_rms_deg"), 3.0, kRoundOff);
  EXPECT_NEAR(metric("estimate_pitch_rms_deg"), 1.0, kRoundOff);
  EXPECT_NEAR(metric("estimate_roll_rms_deg"), 2.0, kRoundOff);
  EXPECT_NEAR(metric("estimate_roll_pitch_rms_deg"), 2.0, kRoundOff);
}

TEST_F(RunMetricsTest, AttitudeErrorIsTheAngleOfTheTurn) {
  truth_.q_NB = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4 * kDegree, Vector3d(1, -1, 2).normalized()));
  signals_.estimate.q_NB = (truth_.q_NB * turn).coeffs() * -1.0;  // the other sign: the same attitude
  fly(100, [](int) {});
  EXPECT_NEAR(metric("estimate_attitude_rms_deg"), 0.4, kRoundOff);
}

TEST_F(RunMetricsTest, EstimateCountsOnlyWhileArmedAndOffTheGround) {
  fly(3000, [&](int i) {
    signals_.flight.fcu.armed = i >= 500;
    truth_.in_contact = i < 1000;
    signals_.estimate.p_NB_N.x() = i < 1000 ? 9.0 : 0.1;
  });
  EXPECT_NEAR(metric("estimate_north_rms_m"), 0.1, kRoundOff);
  EXPECT_NEAR(metric("flight_s"), 5.0, kRoundOff);
  EXPECT_NEAR(metric("simulated_s"), 2999 * 0.0025, kRoundOff);
}

TEST_F(RunMetricsTest, TiltIsTheGreatestAngleToTheVertical) {
  fly(400, [&](int i) {
    truth_.q_NB =
        Eigen::AngleAxisd(1.0, Vector3d::UnitZ()) *
        Eigen::AngleAxisd(i == 160 ? 25.0 * kDegree : 5.0 * kDegree, Vector3d(1, 1, 0).normalized());
  });
  EXPECT_NEAR(metric("max_tilt_deg"), 25.0, kRoundOff);
}

TEST_F(RunMetricsTest, RealTimeFactorIsSimulatedPerWallTime) {
  fly(401, [](int) {});
  EXPECT_TRUE(std::isnan(metric("real_time_factor")));
  metrics_.set_wall_time(0.25);
  EXPECT_NEAR(metric("real_time_factor"), 4.0, kRoundOff);
}

TEST_F(RunMetricsTest, IsNotANumberWhereNothingWasMeasured) {
  signals_.flight.phase = autopilot::FlightPhase::kHold;
  truth_.in_contact = true;
  fly(100, [](int) {});
  for (const char* name : {"path_rms_total_m", "tracking_rms_total_m", "estimate_position_rms_m",
                           "estimate_roll_pitch_rms_deg", "estimate_attitude_rms_deg"}) {
    EXPECT_TRUE(std::isnan(metric(name))) << name;
  }
}

TEST_F(RunMetricsTest, DoesNotTakeAnOperatorsFlightForTheTrajectorys) {
  signals_.flight.operator_setpoint = true;
  fly(100, [](int) {});
  for (const char* name : {"path_rms_total_m", "tracking_rms_total_m", "true_tracking_rms_total_m"}) {
    EXPECT_TRUE(std::isnan(metric(name))) << name;
  }
}

TEST(RunMetricsOnHardwareTest, DoesWithoutTheTruth) {
  autopilot::Signals signals;
  signals.flight.phase = autopilot::FlightPhase::kOffboard;
  signals.flight.fcu.armed = true;
  signals.trajectory.valid = true;
  signals.estimate.v_NB_B = {3.0, 0.0, 0.0};
  RunMetrics metrics({nullptr, &signals});
  for (int i = 0; i < 100; ++i) metrics.observe(i * 10ms);
  for (const Metric& metric : metrics.results()) {
    if (metric.name == "max_speed_mps") {
      EXPECT_EQ(metric.value, 3.0);
    } else if (metric.name == "flight_s") {
      EXPECT_NEAR(metric.value, 1.0, kRoundOff);
    } else if (metric.name.starts_with("true_") || metric.name.starts_with("estimate_")) {
      EXPECT_TRUE(std::isnan(metric.value)) << metric.name;
    }
  }
}

TEST(MetricNamesTest, AreUniqueAndExplained) {
  std::set<std::string> seen;
  for (const Metric& metric : RunMetrics::names_and_units()) {
    EXPECT_TRUE(seen.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.unit.empty()) << metric.name;
    EXPECT_FALSE(metric.meaning.empty()) << metric.name;
  }
  EXPECT_EQ(seen.size(), 36u);
}

TEST(MetricNamesTest, AreNotThereWithoutAnAutopilot) {
  EXPECT_THROW(RunMetrics({nullptr, nullptr}), std::invalid_argument);
}

TEST(AttitudeTest, AnglesComeBackFromTheQuaternion) {
  for (const double roll : {-2.0, 0.0, 1.0}) {
    for (const double pitch : {-1.2, 0.0, 0.9}) {
      for (const double heading : {-3.0, 0.0, 2.0}) {
        const Eigen::Quaterniond q = Eigen::AngleAxisd(heading, Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
                                     Eigen::AngleAxisd(roll, Vector3d::UnitX());
        const EulerAngles angles = euler_of(q);
        EXPECT_NEAR(angles.roll, roll, kRoundOff);
        EXPECT_NEAR(angles.pitch, pitch, kRoundOff);
        EXPECT_NEAR(angles.heading, heading, kRoundOff);
        EXPECT_NEAR(std::cos(tilt_of(q)), std::cos(roll) * std::cos(pitch), kRoundOff);
      }
    }
  }
}

}  // namespace
}  // namespace ironbird::scenarios
