#include "autopilot/trajectory_follower/flatness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ironbird::autopilot {
namespace {

constexpr double kFlatnessRoundOff = 1e-12;
constexpr double kGravity = 9.81;

/// Specific force in N of a thrust along -Bz, per mass.
Vector3 force_of(const AngleHeadingRateThrust& s, double heading, double mass) {
  const Quaternion q_NB = Eigen::AngleAxisd(heading, Vector3::UnitZ()) *
                          Eigen::AngleAxisd(s.pitch, Vector3::UnitY()) *
                          Eigen::AngleAxisd(s.roll, Vector3::UnitX());
  return q_NB * Vector3(0.0, 0.0, -s.thrust / mass);
}

TEST(FlatnessTest, HoversLevelWithTheWeightAsThrust) {
  const AngleHeadingRateThrust s = flat_inverse(Vector3(0, 0, -kGravity), 1.0, 0.0, 2.0);
  EXPECT_EQ(s.roll, 0.0);
  EXPECT_EQ(s.pitch, 0.0);
  EXPECT_EQ(s.heading_rate, 0.0);
  EXPECT_NEAR(s.thrust, 2.0 * kGravity, kFlatnessRoundOff);
}

TEST(FlatnessTest, PitchesDownToGoForwardAndRollsRightToGoRight) {
  const AngleHeadingRateThrust forward = flat_inverse(Vector3(kGravity, 0, -kGravity), 0.0, 0.0, 1.0);
  EXPECT_NEAR(forward.pitch, -M_PI / 4.0, kFlatnessRoundOff);
  EXPECT_NEAR(forward.roll, 0.0, kFlatnessRoundOff);
  const AngleHeadingRateThrust right = flat_inverse(Vector3(0, kGravity, -kGravity), 0.0, 0.0, 1.0);
  EXPECT_NEAR(right.roll, M_PI / 4.0, kFlatnessRoundOff);
  EXPECT_NEAR(right.pitch, 0.0, kFlatnessRoundOff);
}

TEST(FlatnessTest, GivesTheAttitudeWhoseThrustIsTheForceWanted) {
  for (const double heading : {-3.0, -1.0, 0.0, 0.5, 2.5}) {
    for (const Vector3& u_N : {Vector3(1, 2, -9), Vector3(-4, 3, -5), Vector3(0.1, -8, -12)}) {
      const AngleHeadingRateThrust s = flat_inverse(u_N, heading, 0.0, 3.9);
      EXPECT_LT((force_of(s, heading, 3.9) - u_N).norm(), kFlatnessRoundOff * 10.0);
    }
  }
}

TEST(FlatnessTest, GivesTheBodyYawRateThatTurnsTheHeadingUnderAConstantForce) {
  // Independent method: the attitude a moment later, from the inverse itself, gives the angular velocity.
  const double h = 1e-6;
  const double turning = 0.8;
  for (const Vector3& u_N : {Vector3(1, 2, -9), Vector3(-4, 3, -5)}) {
    const auto attitude = [&](double heading) {
      const AngleHeadingRateThrust s = flat_inverse(u_N, heading, turning, 1.0);
      return Quaternion(Eigen::AngleAxisd(heading, Vector3::UnitZ()) *
                        Eigen::AngleAxisd(s.pitch, Vector3::UnitY()) *
                        Eigen::AngleAxisd(s.roll, Vector3::UnitX()));
    };
    const Quaternion turn = attitude(0.3 - turning * h).conjugate() * attitude(0.3 + turning * h);
    const double yaw_rate = 2.0 * turn.z() / (2.0 * h);
    EXPECT_NEAR(flat_inverse(u_N, 0.3, turning, 1.0).heading_rate, yaw_rate, 1e-7);
  }
}

TEST(FlatnessTest, LeavesAForceWithinItsLimitsAlone) {
  const Vector3 u_N(1, 2, -9);
  EXPECT_LT((limit_specific_force(u_N, {4.0, 1.0, 1.0, 20.0}) - u_N).norm(), kFlatnessRoundOff);
}

TEST(FlatnessTest, KeepsALeastLift) {
  EXPECT_LT((limit_specific_force(Vector3(0, 0, 5), {4.0, 1.0, 0.0, 20.0}) - Vector3(0, 0, -4)).norm(),
            kFlatnessRoundOff);
}

TEST(FlatnessTest, LimitsTheTiltAndKeepsDirectionAndLift) {
  const Vector3 limited_N = limit_specific_force(Vector3(30, 40, -10), {4.0, 0.5, 0.0, 100.0});
  EXPECT_LT((limited_N - Vector3(3, 4, -10)).norm(), kFlatnessRoundOff);
}

TEST(FlatnessTest, GivesUpHorizontalForceBeforeLift) {
  const Vector3 limited_N = limit_specific_force(Vector3(9, 0, -12), {4.0, 10.0, 0.0, 13.0});
  EXPECT_LT((limited_N - Vector3(5, 0, -12)).norm(), kFlatnessRoundOff);
  const Vector3 lifted_N = limit_specific_force(Vector3(9, 0, -20), {4.0, 10.0, 0.0, 13.0});
  EXPECT_LT((lifted_N - Vector3(0, 0, -13)).norm(), kFlatnessRoundOff);
}

TEST(FlatnessTest, KeepsALeastMagnitude) {
  const Vector3 limited_N = limit_specific_force(Vector3(3, 0, -4), {1.0, 10.0, 10.0, 20.0});
  EXPECT_LT((limited_N - Vector3(6, 0, -8)).norm(), kFlatnessRoundOff);
}

}  // namespace
}  // namespace ironbird::autopilot
