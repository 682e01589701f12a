#include "autopilot/trajectory_follower/flat_pid_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <variant>

namespace ironbird::autopilot {
namespace {

constexpr double kRoundOff = 1e-9;

class FlatPidFollowerTest : public ::testing::Test {
 protected:
  FlatPidFollowerTest() {
    point_.valid = true;
    estimate_.health = Health::kGood;
    flight_.phase = FlightPhase::kOffboard;
    flight_.fcu.armed = true;
  }

  AngleHeadingRateThrust run() {
    estimate_.stamp += std::chrono::microseconds(2500);
    return std::get<AngleHeadingRateThrust>(follower_.run(point_, estimate_, flight_));
  }

  void set(void (*change)(FlatPidFollowerParams&)) {
    FlatPidFollowerParams params = follower_.params();
    change(params);
    follower_.set_params(params);
  }

  void without_integrals() {
    set([](FlatPidFollowerParams& p) { p.north.ki = p.east.ki = p.down.ki = 0.0; });
  }

  FlatPidFollower follower_;
  TrajectoryPoint point_;
  StateEstimate estimate_;
  FlightStatus flight_;
};

TEST_F(FlatPidFollowerTest, HoversWithItsWeightOnTheReference) {
  const AngleHeadingRateThrust s = run();
  EXPECT_NEAR(s.thrust, 3.9 * 9.81, kRoundOff);
  EXPECT_EQ(s.roll, 0.0);
  EXPECT_EQ(s.pitch, 0.0);
  EXPECT_EQ(s.heading_rate, 0.0);
}

TEST_F(FlatPidFollowerTest, TurnsErrorsAndReferencesIntoTheClosedForm) {
  without_integrals();
  point_.p_N << 0.3, -0.2, 0.1;
  point_.v_N << 0.5, 0.4, -0.3;
  point_.a_N << 0.2, -0.1, 0.3;
  estimate_.v_NB_B << 0.1, 0.0, 0.1;
  const AngleHeadingRateThrust s = run();
  const double north = 3.43 * 0.3 + 2.23 * (0.5 - 0.1) + 0.2;
  const double east = 3.43 * -0.2 + 2.23 * 0.4 - 0.1;
  const double down = 12.1 * 0.1 + 9.16 * (-0.3 - 0.1) + 0.3 - 9.81;
  const double magnitude = std::hypot(north, east, down);
  EXPECT_NEAR(s.thrust, 3.9 * magnitude, kRoundOff);
  EXPECT_NEAR(s.roll, std::asin(east / magnitude), kRoundOff);
  EXPECT_NEAR(s.pitch, std::atan(north / down), kRoundOff);
}

TEST_F(FlatPidFollowerTest, LeansAgainstTheDragOfTheTrajectorysSpeed) {
  set([](FlatPidFollowerParams& p) { p.drag = 0.5; });
  point_.v_N << 2.0, -1.0, 3.0;
  estimate_.v_NB_B = point_.v_N;
  const AngleHeadingRateThrust s = run();
  const double magnitude = std::hypot(1.0, -0.5, -9.81);
  EXPECT_NEAR(s.thrust, 3.9 * magnitude, kRoundOff) << "nothing for the vertical speed";
  EXPECT_NEAR(s.pitch, std::atan(-1.0 / 9.81), kRoundOff);
  EXPECT_NEAR(s.roll, std::asin(-0.5 / magnitude), kRoundOff);
}

TEST_F(FlatPidFollowerTest, IgnoresTheVelocityReferenceLikeTheReferenceWhenToldTo) {
  without_integrals();
  set([](FlatPidFollowerParams& p) { p.use_velocity_reference = false; });
  point_.v_N << 3.0, 0.0, 0.0;
  estimate_.v_NB_B << 1.0, 0.0, 0.0;
  EXPECT_NEAR(std::tan(run().pitch), 2.23 * 1.0 / 9.81, kRoundOff) << "it brakes";
}

TEST_F(FlatPidFollowerTest, TurnsTheShortWayAndFeedsTheHeadingRateForward) {
  estimate_.heading = 3.0;
  point_.heading = -3.0;
  point_.heading_rate = 0.2;
  estimate_.w_NB_B.z() = 0.1;
  const double error = 2.0 * M_PI - 6.0;
  EXPECT_NEAR(run().heading_rate, 3.3 * error + 0.25 * (0.2 - 0.1) + 0.2, kRoundOff);
}

TEST_F(FlatPidFollowerTest, FiltersTheHeadingAcrossSouthWithoutAKick) {
  set([](FlatPidFollowerParams& p) { p.use_velocity_reference = false; });
  estimate_.heading = point_.heading = M_PI - 1e-4;
  run();
  estimate_.heading = point_.heading = -M_PI + 1e-4;
  EXPECT_LT(std::abs(run().heading_rate), 0.25 * 2e-4 / 0.05);
}

TEST_F(FlatPidFollowerTest, NeverAsksForMoreThanItsLimits) {
  for (const Vector3& far :
       {Vector3(1000, -500, 0), Vector3(0, 0, 1000), Vector3(0, 0, -1000), Vector3(50, 0, -50)}) {
    point_.p_N = far;
    point_.heading = 2.0;
    const AngleHeadingRateThrust s = run();
    EXPECT_LE(s.thrust, 80.0 + kRoundOff);
    EXPECT_GE(s.thrust, 4.0);
    EXPECT_LE(std::acos(std::cos(s.roll) * std::cos(s.pitch)), 0.6 + kRoundOff);
    EXPECT_LE(std::abs(s.heading_rate), 2.0 + kRoundOff);
    EXPECT_GE(s.thrust * std::cos(s.roll) * std::cos(s.pitch) / 3.9, 3.924 - kRoundOff);
  }
}

TEST_F(FlatPidFollowerTest, IntegratesOnlyWhileTheCompanionFlies) {
  point_.p_N << 0.5, 0.0, 0.0;
  flight_.fcu.rc_override = 1;
  const double before = run().pitch;
  for (int i = 0; i < 4000; ++i) run();
  EXPECT_EQ(run().pitch, before);
  flight_.fcu.rc_override = 0;
  for (int i = 0; i < 4000; ++i) run();
  // 10 s of 0.5 m at 0.014 1/s^3
  EXPECT_NEAR(std::tan(-run().pitch) - std::tan(-before), 0.07 / 9.81, 1e-5);
  flight_.phase = FlightPhase::kDisarmed;
  EXPECT_EQ(run().pitch, before) << "disarmed, the integrals are gone";
}

TEST_F(FlatPidFollowerTest, HasNoSetpointWithoutAPointOrAnEstimate) {
  const auto nothing = [this] {
    estimate_.stamp += std::chrono::microseconds(2500);
    return std::holds_alternative<NoSetpoint>(follower_.run(point_, estimate_, flight_));
  };
  EXPECT_FALSE(nothing());
  point_.valid = false;
  EXPECT_TRUE(nothing());
  point_.valid = true;
  estimate_.health = Health::kLost;
  EXPECT_TRUE(nothing());
}

TEST_F(FlatPidFollowerTest, NeverPassesAValueThatIsNotFiniteAndRecovers) {
  const double good = run().thrust;
  estimate_.v_NB_B.x() = std::numeric_limits<double>::quiet_NaN();
  estimate_.heading = std::numeric_limits<double>::quiet_NaN();
  estimate_.stamp += std::chrono::microseconds(2500);
  EXPECT_TRUE(std::holds_alternative<NoSetpoint>(follower_.run(point_, estimate_, flight_)));
  estimate_.v_NB_B.x() = 0.0;
  estimate_.heading = 0.0;
  EXPECT_NEAR(run().thrust, good, kRoundOff);
  EXPECT_TRUE(std::isfinite(run().heading_rate));
}

}  // namespace
}  // namespace ironbird::autopilot
