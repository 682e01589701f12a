#include "autopilot/controller/cascade.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ironbird::autopilot {
namespace {

constexpr double kRoundOff = 1e-12;
constexpr double kGravity = 9.81;

/// Gains that are all different, no integrals and no derivatives, so that every product can be written down.
CascadeParams plain() {
  CascadeParams p;
  p.mass = 2.0;
  p.pos_n_to_vel = {0.5, 0, 0};
  p.pos_e_to_vel = {0.6, 0, 0};
  p.pos_d_to_vel = {0.7, 0, 0};
  p.vel_n_to_accel = {1.1, 0, 0};
  p.vel_e_to_accel = {1.2, 0, 0};
  p.vel_d_to_accel = {1.3, 0, 0};
  p.yaw_to_rate = {0.9, 0, 0.1};
  p.roll_to_torque = {3.0, 0, 0.3};
  p.pitch_to_torque = {4.0, 0, 0.4};
  p.yaw_to_torque = {0.8, 0, 0.2};
  p.roll_rate_to_torque = {0.31, 0, 0};
  p.pitch_rate_to_torque = {0.32, 0, 0};
  p.yaw_rate_to_torque = {0.33, 0, 0};
  p.equilibrium_throttle = 0.5;
  return p;
}

class CascadeTest : public ::testing::Test {
 protected:
  CascadeTest() {
    estimate_.health = Health::kGood;
    estimate_.p_NB_N << 1.0, 2.0, -10.0;
    estimate_.v_NB_B << 0.1, -0.2, 0.05;
    estimate_.heading = 0.0;
    estimate_.w_NB_B << 0.02, -0.03, 0.04;
  }

  template <class Command>
  Command fly(const ControlSetpoint& setpoint) {
    return std::get<Command>(cascade_.fly(setpoint, estimate_, step_));
  }

  /// The estimate's attitude, consistently as angles and as quaternion.
  void turn(double roll, double pitch, double heading) {
    estimate_.roll = roll;
    estimate_.pitch = pitch;
    estimate_.heading = heading;
    estimate_.q_NB = Eigen::AngleAxisd(heading, Vector3::UnitZ()) *
                     Eigen::AngleAxisd(pitch, Vector3::UnitY()) * Eigen::AngleAxisd(roll, Vector3::UnitX());
  }

  /// Angle command of an acceleration in V, the closed form.
  static AngleCommand angles_of(const Vector3& a_V, double heading_rate) {
    const double magnitude = std::hypot(a_V.x(), a_V.y(), kGravity - a_V.z());
    const double roll = std::asin(a_V.y() / magnitude);
    const double pitch = -std::asin(a_V.x() / magnitude / std::cos(roll));
    return {roll, pitch, heading_rate, 0.5 * (1.0 - a_V.z() / kGravity)};
  }

  static void expect_same(const AngleCommand& a, const AngleCommand& b) {
    EXPECT_NEAR(a.roll, b.roll, kRoundOff);
    EXPECT_NEAR(a.pitch, b.pitch, kRoundOff);
    EXPECT_NEAR(a.heading_rate, b.heading_rate, kRoundOff);
    EXPECT_NEAR(a.throttle, b.throttle, kRoundOff);
  }

  Cascade cascade_{plain()};
  StateEstimate estimate_;
  Cascade::Step step_{0.0025, true, false};
};

TEST_F(CascadeTest, Entry0TurnsAPositionIntoVelocityAccelerationAndAngles) {
  const Vector3 v_N(0.5 * 0.4, 0.6 * -0.5, 0.7 * 0.2);
  const Vector3 a_V(1.1 * (v_N.x() - 0.1), 1.2 * (v_N.y() + 0.2), 1.3 * (v_N.z() - 0.05));
  expect_same(fly<AngleCommand>(PositionHeading{Vector3(1.4, 1.5, -9.8), 0.3}),
              angles_of(a_V, 0.9 * 0.3 - 0.1 * 0.04));
}

struct LimitedCase {
  const char* name;
  ControlSetpoint asked;
  ControlSetpoint allowed;
};

class CascadeLimitsTest : public CascadeTest, public ::testing::WithParamInterface<LimitedCase> {};

TEST_P(CascadeLimitsTest, LimitAtEveryEntryWhatMayBeAskedFor) {
  CascadeParams p = plain();
  p.max_horizontal_acceleration = 1e3;  // so that only one kind of limit is at work
  p.max_horizontal_speed = 5.0;
  if (std::holds_alternative<AccelerationHeadingRate>(GetParam().asked)) p.max_horizontal_acceleration = 5.0;
  cascade_.set_params(p);
  const auto given = fly<AngleCommand>(GetParam().asked);
  cascade_.reset();
  expect_same(given, fly<AngleCommand>(GetParam().allowed));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, CascadeLimitsTest,
    ::testing::Values(LimitedCase{"Entry0OnADiagonal", PositionHeading{Vector3(1e3, 1e3, -10), 0.0},
                                  VelocityHeadingRate{Vector3(5 * std::sqrt(0.5), 5 * std::sqrt(0.5), 0),
                                                      -0.1 * 0.04}},
                      LimitedCase{"Entry1", VelocityHeightHeadingRate{Vector2(60, 0), -10, 0.0},
                                  VelocityHeadingRate{Vector3(5, 0, 0), 0.0}},
                      LimitedCase{"Entry2", AccelerationHeadingRate{Vector3(30, 40, 0), 0.0},
                                  AccelerationHeadingRate{Vector3(3, 4, 0), 0.0}},
                      LimitedCase{"Entry2Upwards", AccelerationHeadingRate{Vector3(0, 0, -50), 0.0},
                                  AccelerationHeadingRate{Vector3(0, 0, -8), 0.0}},
                      LimitedCase{"Entry3", VelocityHeadingRate{Vector3(-36, 48, 0), 0.0},
                                  VelocityHeadingRate{Vector3(-3, 4, 0), 0.0}},
                      LimitedCase{"Entry3Downwards", VelocityHeadingRate{Vector3(0, 0, 30), 0.0},
                                  VelocityHeadingRate{Vector3(0, 0, 2), 0.0}},
                      LimitedCase{"Entry4Upwards", PositionClimbHeading{Vector2(1, 2), -30.0, 0.0},
                                  PositionClimbHeading{Vector2(1, 2), -3.0, 0.0}}),
    [](const auto& case_) { return case_.param.name; });

TEST_F(CascadeTest, GoesOnFromTheCommandOfAnother) {
  // GIVEN a cascade whose integrals hold a wind and a crooked rotor
  CascadeParams p = plain();
  p.vel_n_to_accel.ki = p.vel_d_to_accel.ki = 0.5;
  p.roll_to_torque.ki = 0.4;
  cascade_.set_params(p);
  step_.thrust_in_newtons = true;
  const ControlSetpoint hover = VelocityHeadingRate{Vector3(0.4, -0.2, -0.1), 0.0};
  turn(0.0, 0.0, 0.0);
  for (int i = 0; i < 2000; ++i) cascade_.fly(hover, estimate_, step_);
  const auto before = fly<PassThroughCommand>(hover);
  // WHEN another one takes over THEN it asks for the same thrust and torque, not for those of an empty memory
  Cascade other(p);
  const auto empty = std::get<PassThroughCommand>(other.fly(hover, estimate_, step_));
  ASSERT_GT(std::abs(empty.thrust - before.thrust), 0.3);
  Cascade successor(p);
  successor.resume(before, estimate_);
  const auto after = std::get<PassThroughCommand>(successor.fly(hover, estimate_, step_));
  EXPECT_NEAR(after.thrust, before.thrust, 1e-2);
  EXPECT_NEAR(after.M_B.x(), before.M_B.x(), 1e-2);
}

TEST_F(CascadeTest, Entry1HoldsTheHeightAndPassesTheHorizontalVelocity) {
  const Vector3 a_V(1.1 * (0.7 - 0.1), 1.2 * (0.3 + 0.2), 1.3 * (0.7 * -0.5 - 0.05));
  expect_same(fly<AngleCommand>(VelocityHeightHeadingRate{Vector2(0.7, 0.3), -10.5, 0.2}),
              angles_of(a_V, 0.2));
}

TEST_F(CascadeTest, Entry2TiltsForTheAccelerationAndCarriesTheWeightWhileTilted) {
  const Vector3 a_V(1.0, -2.0, 0.5);
  expect_same(fly<AngleCommand>(AccelerationHeadingRate{a_V, 0.1}), angles_of(a_V, 0.1));
  turn(0.2, -0.3, 0.0);
  EXPECT_NEAR(fly<AngleCommand>(AccelerationHeadingRate{a_V, 0.1}).throttle,
              0.5 * (1.0 - 0.5 / kGravity) / (std::cos(0.2) * std::cos(0.3)), kRoundOff);
}

TEST_F(CascadeTest, Entry2AsksForAThrustThatMakesExactlyTheAcceleration) {
  step_.thrust_in_newtons = true;
  const Vector3 a_V(1.0, -2.0, 0.5);
  const AngleCommand angles = angles_of(a_V, 0.0);
  turn(angles.roll, angles.pitch, 0.0);
  const PassThroughCommand command = fly<PassThroughCommand>(AccelerationHeadingRate{a_V, 0.04});
  const Vector3 made_N = estimate_.q_NB * Vector3(0, 0, -command.thrust / 2.0) + Vector3(0, 0, kGravity);
  EXPECT_LT((made_N - a_V).norm(), 1e-9);
  EXPECT_NEAR(command.M_B.x(), -0.3 * 0.02, kRoundOff) << "the attitude is there: only damping";
}

TEST_F(CascadeTest, Entry3TurnsAVelocityIntoAccelerationAlongTheHeading) {
  turn(0.0, 0.0, M_PI / 2.0);
  estimate_.v_NB_B.setZero();
  // North is to the left of a vehicle that looks east.
  expect_same(fly<AngleCommand>(VelocityHeadingRate{Vector3(0.5, 0.0, 0.0), 0.1}),
              angles_of(Vector3(0.0, -1.1 * 0.5, 0.0), 0.1));
}

TEST_F(CascadeTest, Entry4HoldsThePlaceWhileItClimbs) {
  const Vector3 a_V(1.1 * (0.5 * 0.4 - 0.1), 1.2 * (0.6 * -0.5 + 0.2), 1.3 * (-0.5 - 0.05));
  expect_same(fly<AngleCommand>(PositionClimbHeading{Vector2(1.4, 1.5), -0.5, 0.3}),
              angles_of(a_V, 0.9 * 0.3 - 0.1 * 0.04));
}

TEST_F(CascadeTest, Entry5TurnsAHeadingIntoAYawRateTheShortWay) {
  turn(0.0, 0.0, 3.0);
  const AngleCommand command = fly<AngleCommand>(AngleHeadingThrottle{0.1, -0.2, -3.0, 0.6});
  expect_same(command, {0.1, -0.2, 0.9 * (2.0 * M_PI - 6.0) - 0.1 * 0.04, 0.6});
}

TEST_F(CascadeTest, Entry6IsTheAngleModeOfTheFcu) {
  expect_same(fly<AngleCommand>(AngleHeadingRateThrottle{0.1, -0.2, 0.3, 0.6}), {0.1, -0.2, 0.3, 0.6});
}

TEST_F(CascadeTest, Entry7IsTheRateModeOfTheFcu) {
  const RateCommand command = fly<RateCommand>(RateThrottle{Vector3(0.1, -0.2, 0.3), 0.6});
  EXPECT_EQ(command.w_NB_B, Vector3(0.1, -0.2, 0.3));
  EXPECT_EQ(command.throttle, 0.6);
}

TEST_F(CascadeTest, Entry8PassesTorqueAndThrust) {
  const PassThroughCommand command = fly<PassThroughCommand>(TorqueThrust{Vector3(0.1, -0.2, 0.3), 20.0});
  EXPECT_EQ(command.M_B, Vector3(0.1, -0.2, 0.3));
  EXPECT_EQ(command.thrust, 20.0) << "positive up";
}

TEST_F(CascadeTest, Entry9TurnsAnAttitudeIntoTorqueTheShortWay) {
  turn(0.05, 0.02, 3.0);
  const PassThroughCommand command = fly<PassThroughCommand>(AngleHeadingThrust{0.1, -0.2, -3.0, 20.0});
  EXPECT_NEAR(command.M_B.x(), 3.0 * 0.05 - 0.3 * 0.02, kRoundOff);
  EXPECT_NEAR(command.M_B.y(), 4.0 * -0.22 + 0.4 * 0.03, kRoundOff);
  EXPECT_NEAR(command.M_B.z(), 0.8 * (2.0 * M_PI - 6.0) - 0.2 * 0.04, kRoundOff);
}

TEST_F(CascadeTest, Entry10TurnsAnglesAndAYawRateIntoTorque) {
  const PassThroughCommand command = fly<PassThroughCommand>(AngleHeadingRateThrust{0.1, -0.2, 0.5, 20.0});
  EXPECT_NEAR(command.M_B.x(), 3.0 * 0.1 - 0.3 * 0.02, kRoundOff);
  EXPECT_NEAR(command.M_B.y(), 4.0 * -0.2 + 0.4 * 0.03, kRoundOff);
  EXPECT_NEAR(command.M_B.z(), 0.33 * (0.5 - 0.04), kRoundOff);
  EXPECT_EQ(command.thrust, 20.0);
}

TEST_F(CascadeTest, Entry11TurnsRatesIntoTorque) {
  const PassThroughCommand command = fly<PassThroughCommand>(RateThrust{Vector3(0.1, -0.2, 0.5), 20.0});
  EXPECT_NEAR(command.M_B.x(), 0.31 * (0.1 - 0.02), kRoundOff);
  EXPECT_NEAR(command.M_B.y(), 0.32 * (-0.2 + 0.03), kRoundOff);
  EXPECT_NEAR(command.M_B.z(), 0.33 * (0.5 - 0.04), kRoundOff);
}

TEST_F(CascadeTest, SaysNothingWithoutASetpoint) {
  EXPECT_TRUE(std::holds_alternative<SilenceCommand>(cascade_.fly(NoSetpoint{}, estimate_, step_)));
}

TEST_F(CascadeTest, LimitsEveryCommandInRadiansAndNewtons) {
  const double far = 1e6;
  const AngleCommand angles = fly<AngleCommand>(AngleHeadingRateThrottle{far, -far, far, far});
  EXPECT_EQ(angles.roll, 0.7);
  EXPECT_EQ(angles.pitch, -0.7);
  EXPECT_EQ(angles.heading_rate, 2.0);
  EXPECT_EQ(angles.throttle, 0.95);
  const RateCommand rates = fly<RateCommand>(RateThrottle{Vector3(far, -far, far), -far});
  EXPECT_EQ(rates.w_NB_B, Vector3(4.0, -4.0, 2.0));
  EXPECT_EQ(rates.throttle, 0.05);
  const PassThroughCommand torque = fly<PassThroughCommand>(TorqueThrust{Vector3(far, -far, far), -far});
  EXPECT_EQ(torque.M_B, Vector3(5.0, -5.0, 1.0));
  EXPECT_EQ(torque.thrust, 2.0);
  EXPECT_EQ(fly<PassThroughCommand>(TorqueThrust{Vector3::Zero(), far}).thrust, 80.0);
}

TEST_F(CascadeTest, StaysBoundedWhenUpsideDownAndInFreeFall) {
  CascadeParams params = plain();
  params.max_descent_acceleration = 9.0;
  cascade_.set_params(params);
  step_.thrust_in_newtons = true;
  turn(3.1, 1.5, 0.0);
  const PassThroughCommand command =
      fly<PassThroughCommand>(AccelerationHeadingRate{Vector3(0, 0, 50.0), 0.0});
  EXPECT_GE(command.thrust, 2.0);
  EXPECT_LE(command.thrust, 2.0 * 0.1 * kGravity / 0.5 + kRoundOff);
  EXPECT_TRUE(command.M_B.allFinite());
}

TEST_F(CascadeTest, AsksForNoTorqueNearTheGroundOnlyWhenToldTo) {
  CascadeParams params = plain();
  estimate_.p_NB_N.z() = -0.1;
  EXPECT_NE(fly<PassThroughCommand>(TorqueThrust{Vector3(1, 1, 0.5), 20.0}).M_B.norm(), 0.0);
  params.min_altitude_for_attitude_control = 0.3;
  cascade_.set_params(params);
  EXPECT_EQ(fly<PassThroughCommand>(TorqueThrust{Vector3(1, 1, 0.5), 20.0}).M_B.norm(), 0.0);
  EXPECT_EQ(fly<PassThroughCommand>(TorqueThrust{Vector3(1, 1, 0.5), 20.0}).thrust, 20.0);
  EXPECT_EQ(fly<AngleCommand>(AngleHeadingRateThrottle{0.1, 0.1, 0.1, 0.6}).roll, 0.0);
  EXPECT_EQ(fly<RateCommand>(RateThrottle{Vector3(1, 1, 1), 0.6}).w_NB_B.norm(), 0.0);
}

TEST_F(CascadeTest, ForgetsTheIntegralsOfLoopsThatRestAndOfAllWhileOverridden) {
  CascadeParams params = plain();
  params.roll_to_torque.ki = 1.0;
  cascade_.set_params(params);
  const ControlSetpoint leaning = AngleHeadingRateThrust{0.1, 0.0, 0.0, 20.0};
  const double at_first = fly<PassThroughCommand>(leaning).M_B.x();
  for (int i = 0; i < 400; ++i) fly<PassThroughCommand>(leaning);
  EXPECT_GT(fly<PassThroughCommand>(leaning).M_B.x(), at_first + 0.09);
  fly<AngleCommand>(AngleHeadingRateThrottle{0.1, 0.0, 0.0, 0.5});
  EXPECT_NEAR(fly<PassThroughCommand>(leaning).M_B.x(), at_first, kRoundOff) << "the loop rested for a step";
  for (int i = 0; i < 400; ++i) fly<PassThroughCommand>(leaning);
  step_.integrate = false;
  fly<PassThroughCommand>(leaning);
  EXPECT_NEAR(fly<PassThroughCommand>(leaning).M_B.x(), 3.0 * 0.1 - 0.3 * 0.02, kRoundOff);
}

TEST_F(CascadeTest, KnowsWhatShareOfTheWeightItLifts) {
  fly<PassThroughCommand>(TorqueThrust{Vector3::Zero(), kGravity});
  EXPECT_NEAR(cascade_.lift(), 0.5, kRoundOff);
  fly<AngleCommand>(AngleHeadingRateThrottle{0.0, 0.0, 0.0, 0.25});
  EXPECT_NEAR(cascade_.lift(), 0.5, kRoundOff);
}

}  // namespace
}  // namespace ironbird::autopilot
