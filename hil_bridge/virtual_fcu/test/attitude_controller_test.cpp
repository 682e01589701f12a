#include "hil_bridge/virtual_fcu/attitude_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr float kControlDt = 0.0025F;
constexpr float kControlRoundOff = 1e-6F;  // of float32 at magnitudes near one

class AttitudeControllerTest : public ::testing::Test {
 protected:
  AttitudeControllerTest() {
    constexpr float kHalfRoll = 0.05F;
    constexpr float kHalfPitch = -0.1F;
    attitude.q_NB = {std::cos(kHalfRoll) * std::cos(kHalfPitch), std::sin(kHalfRoll) * std::cos(kHalfPitch),
                     std::cos(kHalfRoll) * std::sin(kHalfPitch), -std::sin(kHalfRoll) * std::sin(kHalfPitch)};
    attitude.w_NB_B = {0.3F, -0.4F, 0.5F};
    for (Channel& channel : command.u) channel.active = true;
    set_torques(ChannelKind::kAngle, ChannelKind::kAngle, ChannelKind::kRate);
    rebuild();
  }
  void rebuild() { controller.rebuild(parameters, kSeaLevelDensity); }
  void set_torques(ChannelKind roll, ChannelKind pitch, ChannelKind yaw) {
    command.u[kRoll].kind = roll;
    command.u[kPitch].kind = pitch;
    command.u[kYaw].kind = yaw;
  }
  std::array<float, 10> run(bool armed = true, float dt = kControlDt) {
    return controller.run(command, attitude, dt, armed);
  }

  ParameterStore parameters;
  AttitudeController controller;
  Attitude attitude;
  Command command;
};

TEST_F(AttitudeControllerTest, TurnsAnglesIntoTorquesDampedByTheGyro) {
  command.u[kRoll].value = 0.25F;
  command.u[kPitch].value = 0.05F;
  const std::array<float, 10> u = run();
  EXPECT_NEAR(u[kRoll], 0.15F * (0.25F - 0.1F) - 0.05F * 0.3F, kControlRoundOff);
  EXPECT_NEAR(u[kPitch], 0.15F * (0.05F + 0.2F) + 0.05F * 0.4F, kControlRoundOff);
}

TEST_F(AttitudeControllerTest, TurnsRatesIntoTorques) {
  set_torques(ChannelKind::kRate, ChannelKind::kRate, ChannelKind::kRate);
  command.u[kRoll].value = 1.0F;
  command.u[kPitch].value = 2.0F;
  command.u[kYaw].value = -1.0F;
  const std::array<float, 10> u = run();
  EXPECT_NEAR(u[kRoll], 0.07F * (1.0F - 0.3F), kControlRoundOff);
  EXPECT_NEAR(u[kPitch], 0.07F * (2.0F + 0.4F), kControlRoundOff);
  EXPECT_NEAR(u[kYaw], 0.25F * (-1.0F - 0.5F), kControlRoundOff);
}

TEST_F(AttitudeControllerTest, LetsPassThroughValuesPassAndAddsEquilibriumTorques) {
  parameters.set(parameter("X_EQ_TORQUE"), 0.01F);
  parameters.set(parameter("Y_EQ_TORQUE"), 0.02F);
  parameters.set(parameter("Z_EQ_TORQUE"), 0.03F);
  rebuild();
  for (Channel& channel : command.u) channel.kind = ChannelKind::kPassThrough;
  for (std::size_t i = 0; i < 10; ++i) command.u[i].value = 0.1F * static_cast<float>(i);
  const std::array<float, 10> u = run();
  for (std::size_t i = 0; i < 10; ++i) {
    const float added = i == kRoll ? 0.01F : i == kPitch ? 0.02F : i == kYaw ? 0.03F : 0.0F;
    EXPECT_NEAR(u[i], 0.1F * static_cast<float>(i) + added, kControlRoundOff) << i;
  }
}

TEST_F(AttitudeControllerTest, GivesEveryLoopItsOwnGains) {
  struct Row {
    const char* loop;
    std::size_t axis;
    ChannelKind kind;
  };
  for (const Row& row :
       {Row{"PID_ROLL_RATE", kRoll, ChannelKind::kRate}, Row{"PID_PITCH_RATE", kPitch, ChannelKind::kRate},
        Row{"PID_YAW_RATE", kYaw, ChannelKind::kRate}, Row{"PID_ROLL_ANG", kRoll, ChannelKind::kAngle},
        Row{"PID_PITCH_ANG", kPitch, ChannelKind::kAngle}}) {
    parameters.set_defaults();
    controller = AttitudeController();
    attitude = {};
    command = {};
    const std::string loop = row.loop;
    parameters.set(find_parameter(loop + "_P"), 0.5F);
    parameters.set(find_parameter(loop + "_I"), 2.0F);
    parameters.set(find_parameter(loop + "_D"), 0.3F);
    rebuild();
    command.u[row.axis] = {.value = 0.4F, .kind = row.kind, .active = true};
    command.u[kForceZ].value = 0.5F;
    EXPECT_NEAR(run()[row.axis], 0.5F * 0.4F + 2.0F * 0.4F * kControlDt, kControlRoundOff)
        << loop << " P and I";
    // A rate that jumps to 0.2 rad/s: the angle loops take it as it is, the others differentiate it.
    attitude.w_NB_B = {0.2F, 0.2F, 0.2F};
    command.u[row.axis].value = row.kind == ChannelKind::kRate ? 0.2F : 0.0F;
    const float derivative =
        row.kind == ChannelKind::kRate ? 2.0F / (2.0F * 0.05F + kControlDt) * 0.2F : 0.2F;
    EXPECT_NEAR(run(false)[row.axis], -0.3F * derivative, 1e-5F) << loop << " D";
  }
}

TEST_F(AttitudeControllerTest, FindsTheMaximumThrustAtTheDensityOfTheDay) {
  controller.rebuild(parameters, 1.0F);
  const double four_pi_squared = 4.0 * std::numbers::pi * std::numbers::pi;
  const double a = 0.042 * 1.0 * std::pow(0.381, 5) * 0.0045 / (four_pi_squared * 0.01706);
  const double b = 0.01706;
  const double c = 1.5 * 0.042 - 25.0;
  const double speed = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  const double thrust = 4.0 * 1.0 * std::pow(0.381, 4) * 0.075 * speed * speed / four_pi_squared;
  EXPECT_NEAR(controller.maximum_thrust(), thrust, 0.01);
}

TEST_F(AttitudeControllerTest, TreatsAnAngleOnYawAsAValue) {
  command.u[kYaw] = {.value = 0.4F, .kind = ChannelKind::kAngle, .active = true};
  EXPECT_FLOAT_EQ(run()[kYaw], 0.4F);
}

TEST_F(AttitudeControllerTest, ScalesThrottleByTheGreatestThrottleAndTurnsItUp) {
  command.u[kForceX].value = 0.2F;
  command.u[kForceZ].value = 0.5F;
  std::array<float, 10> u = run();
  EXPECT_NEAR(u[kForceX], 0.2F * 0.7F, kControlRoundOff);
  EXPECT_NEAR(u[kForceZ], -0.5F * 0.7F, kControlRoundOff);
  parameters.set(parameter("USE_MOTOR_PARAM"), 1);
  rebuild();
  u = run();
  EXPECT_NEAR(u[kForceZ] / controller.maximum_thrust(), -0.35F, kControlRoundOff);
}

TEST_F(AttitudeControllerTest, IntegratesOnlyArmedWithThrottleAndShortSteps) {
  parameters.set(parameter("PID_ROLL_ANG_P"), 0.0F);
  parameters.set(parameter("PID_ROLL_ANG_D"), 0.0F);
  parameters.set(parameter("PID_ROLL_ANG_I"), 2.0F);
  rebuild();
  command.u[kRoll].value = 1.1F;  // an error of 1 rad
  command.u[kForceZ].value = 0.1F;
  EXPECT_EQ(run()[kRoll], 0.0F) << "throttle must be above 0.1";
  command.u[kForceZ].value = 0.2F;
  EXPECT_EQ(run(false)[kRoll], 0.0F) << "not armed";
  EXPECT_EQ(run(true, 0.01F)[kRoll], 0.0F) << "dt must be below 10 ms";
  EXPECT_NEAR(run()[kRoll], 2.0F * kControlDt, kControlRoundOff);
  EXPECT_NEAR(run()[kRoll], 4.0F * kControlDt, kControlRoundOff);
  EXPECT_EQ(run(false)[kRoll], 0.0F) << "the term drops out";
  EXPECT_NEAR(run()[kRoll], 6.0F * kControlDt, kControlRoundOff) << "and jumps back in";
}

TEST_F(AttitudeControllerTest, KeepsIntegralsWhenGainsChange) {
  parameters.set(parameter("PID_ROLL_ANG_I"), 1.0F);
  rebuild();
  command.u[kRoll].value = 0.1F + 1.0F;
  command.u[kForceZ].value = 0.5F;
  run();
  parameters.set(parameter("PID_ROLL_ANG_P"), 0.0F);
  parameters.set(parameter("PID_ROLL_ANG_D"), 0.0F);
  rebuild();
  EXPECT_NEAR(run()[kRoll], 2.0F * kControlDt, kControlRoundOff);
}

TEST_F(AttitudeControllerTest, DoesNotIntegrateInPassThroughThrustBecauseUpIsNegative) {
  parameters.set(parameter("PID_ROLL_ANG_P"), 0.0F);
  parameters.set(parameter("PID_ROLL_ANG_D"), 0.0F);
  parameters.set(parameter("PID_ROLL_ANG_I"), 2.0F);
  rebuild();
  command.u[kForceZ] = {.value = -30.0F, .kind = ChannelKind::kPassThrough, .active = true};
  command.u[kRoll].value = 1.1F;
  EXPECT_EQ(run()[kRoll], 0.0F);
}

TEST_F(AttitudeControllerTest, BandLimitsTheDerivativeOfARate) {
  parameters.set(parameter("PID_YAW_RATE_P"), 0.0F);
  parameters.set(parameter("PID_YAW_RATE_D"), 1.0F);
  rebuild();
  attitude.w_NB_B.z = 0.0F;
  run();
  // A ramp of 4 rad/s^2: the derivative tends to 4 with the time constant PID_TAU (bilinear, tau 0.05 s).
  const double ratio = (2.0 * 0.05 - 0.0025) / (2.0 * 0.05 + 0.0025);
  double expected = 0.0;
  for (int k = 1; k <= 40; ++k) {
    attitude.w_NB_B.z = 4.0F * kControlDt * static_cast<float>(k);
    expected = 4.0 + (expected - 4.0) * ratio;
    ASSERT_NEAR(run()[kYaw], -expected, 1e-4);
  }
  EXPECT_NEAR(expected, 4.0 * (1.0 - std::exp(-0.1 / 0.05)), 0.01);
}

TEST_F(AttitudeControllerTest, HasNoDerivativeInAStepOfATenthOfAMillisecond) {
  parameters.set(parameter("PID_YAW_RATE_P"), 0.0F);
  parameters.set(parameter("PID_YAW_RATE_D"), 1.0F);
  rebuild();
  attitude.w_NB_B.z = 3.0F;
  EXPECT_EQ(run(true, 0.0001F)[kYaw], 0.0F);
  attitude.w_NB_B.z = 3.0F;
  EXPECT_EQ(run(true, kControlDt)[kYaw], 0.0F) << "the short step remembered the rate";
}

TEST_F(AttitudeControllerTest, HasNoLimit) {
  set_torques(ChannelKind::kRate, ChannelKind::kRate, ChannelKind::kRate);
  command.u[kYaw].value = 1e6F;
  EXPECT_GT(run()[kYaw], 1e5F);
}

TEST_F(AttitudeControllerTest, FindsTheTorquesOfALevelVehicleForTheTrim) {
  command.u[kRoll].value = 0.1F;
  command.u[kYaw].value = 0.2F;
  const std::array<float, 3> torques = controller.trim(command);
  EXPECT_NEAR(torques[0], 0.015F, kControlRoundOff);
  EXPECT_EQ(torques[1], 0.0F);
  EXPECT_NEAR(torques[2], 0.05F, kControlRoundOff);
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
