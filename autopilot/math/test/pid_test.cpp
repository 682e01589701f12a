#include "autopilot/math/pid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ironbird::autopilot {
namespace {

constexpr double kPidRoundOff = 1e-12;
constexpr double kTau = 0.05;
constexpr double kDt = 0.0025;

Pid made(double kp, double ki, double kd, double limit = Pid::kUnlimited) {
  Pid pid;
  pid.configure({kp, ki, kd}, kTau, -limit, limit);
  return pid;
}

TEST(PidTest, IsProportionalToTheErrorAndDampsTheRate) {
  Pid pid = made(2.0, 0.0, 0.5);
  EXPECT_NEAR(pid.run(3.0, 4.0, kDt), 2.0 * 3.0 - 0.5 * 4.0, kPidRoundOff);
}

TEST(PidTest, IntegratesAConstantErrorExactly) {
  Pid pid = made(0.0, 0.7, 0.0);
  double u = 0.0;
  for (int i = 0; i < 400; ++i) u = pid.run(1.5, 0.0, kDt);
  EXPECT_NEAR(u, 0.7 * 1.5 * 400 * kDt, kPidRoundOff);
}

TEST(PidTest, IntegratesARampByTheTrapezoidalRuleExactly) {
  Pid pid = made(0.0, 1.0, 0.0);
  pid.run(0.0, 0.0, 0.0);
  double u = 0.0;
  for (int i = 1; i <= 400; ++i) u = pid.run(i * kDt, 0.0, kDt);
  EXPECT_NEAR(u, 0.5 * 400 * kDt * 400 * kDt, kPidRoundOff);
}

TEST(PidTest, DoesNotIntegrateWhenToldNotToOrOverAGap) {
  Pid pid = made(0.0, 1.0, 0.0);
  pid.run(1.0, 0.0, kDt, false);
  pid.run(1.0, 0.0, 2.0);
  EXPECT_EQ(pid.integral_part(), 0.0);
}

TEST(PidTest, DifferentiatesARampOfTheMeasurementAfterTheFilterSettled) {
  Pid pid = made(0.0, 0.0, 1.0);
  double u = 0.0;
  // After t seconds the filtered derivative of a ramp is 1 - exp(-t/tau), but for the bilinear transform's
  // error of order (dt/tau)^2.
  for (int i = 0; i <= 40; ++i) u = pid.run_filtered(0.0, 3.0 * i * kDt, kDt);
  EXPECT_NEAR(-u, 3.0 * (1.0 - std::exp(-40 * kDt / kTau)), 3.0 * (kDt / kTau));
  for (int i = 41; i <= 800; ++i) u = pid.run_filtered(0.0, 3.0 * i * kDt, kDt);
  EXPECT_NEAR(-u, 3.0, 1e-9);
}

TEST(PidTest, DoesNotKickOnItsFirstStepOrAfterAGap) {
  Pid pid = made(0.0, 0.0, 1.0);
  EXPECT_EQ(pid.run_filtered(0.0, 100.0, kDt), 0.0);
  EXPECT_EQ(pid.run_filtered(0.0, -100.0, 1.5), 0.0);
}

TEST(PidTest, StaysWithinItsLimits) {
  Pid pid = made(10.0, 5.0, 0.0, 2.0);
  EXPECT_EQ(pid.run(1.0, 0.0, kDt), 2.0);
  EXPECT_EQ(pid.run(-1.0, 0.0, kDt), -2.0);
}

TEST(PidTest, DoesNotWindUpWhileTheProportionalPartAloneIsAtTheLimit) {
  Pid pid = made(10.0, 5.0, 0.0, 2.0);
  for (int i = 0; i < 4000; ++i) pid.run(1.0, 0.0, kDt);
  EXPECT_EQ(pid.integral_part(), 0.0);
}

TEST(PidTest, GivesTheIntegralNoMoreThanTheRestOfTheRange) {
  Pid pid = made(1.0, 5.0, 0.0, 2.0);
  for (int i = 0; i < 4000; ++i) pid.run(0.5, 0.0, kDt);
  EXPECT_NEAR(pid.integral_part(), 1.5, kPidRoundOff);
  EXPECT_LT(pid.run(-0.5, 0.0, kDt), 1.1) << "it comes back at once";
}

TEST(PidTest, KeepsItsIntegralWhenOnlyOtherGainsChange) {
  Pid pid = made(1.0, 2.0, 0.0);
  pid.run(1.0, 0.0, 0.5);
  const double before = pid.integral_part();
  pid.configure({3.0, 2.0, 1.0}, kTau);
  EXPECT_EQ(pid.integral_part(), before);
  pid.configure({3.0, 2.5, 1.0}, kTau);
  EXPECT_EQ(pid.integral_part(), 0.0);
}

TEST(PidTest, IsUntouchedByValuesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pid pid = made(1.0, 2.0, 1.0);
  pid.run_filtered(1.0, 0.0, 0.5);
  const double before = pid.integral_part();
  EXPECT_EQ(pid.run(nan, 0.0, kDt), 0.0);
  EXPECT_EQ(pid.run(0.0, nan, kDt), 0.0);
  EXPECT_EQ(pid.run_filtered(1.0, nan, kDt), 0.0);
  EXPECT_EQ(pid.run_filtered(std::numeric_limits<double>::infinity(), 0.0, kDt), 0.0);
  EXPECT_EQ(pid.integral_part(), before);
}

}  // namespace
}  // namespace ironbird::autopilot
