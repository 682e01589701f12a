#include "hil_bridge/interlock/command_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using enum CommandFault;

constexpr CommandLimits kLimits = {
    .thrust = 50.0, .torque = 2.0, .angle = 0.7, .rate = 3.0, .greatest_age = milliseconds(5)};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

rosflight::OffboardControl direct(float thrust, float roll = 0.0F, float pitch = 0.0F, float yaw = 0.0F) {
  return {.u = {0, 0, -thrust, roll, pitch, yaw}, .ignore = 0, .mode = 0};
}

CommandFault fault(const rosflight::OffboardControl& command) {
  CommandCheck check(kLimits);
  return check.check({command, milliseconds(10), 1}, milliseconds(11));
}

TEST(CommandCheckTest, PassesWhatTheVehicleCanDo) {
  EXPECT_EQ(fault(direct(0.0F)), kNone);
  EXPECT_EQ(fault(direct(50.0F, 2.0F, -2.0F, 2.0F)), kNone);
  EXPECT_EQ(fault({.u = {0, 0, 1.0F, 3.0F, -3.0F, 3.0F}, .mode = 1}), kNone);
  EXPECT_EQ(fault({.u = {0, 0, 0.5F, 0.7F, -0.7F, 3.0F}, .mode = 2}), kNone);
}

TEST(CommandCheckTest, RefusesWhatIsNoNumberInAnyPlace) {
  for (std::size_t k = 0; k < 10; ++k) {
    for (const float value : {kNan, kInfinity, -kInfinity}) {
      rosflight::OffboardControl command = direct(10.0F);
      command.u[k] = value;
      EXPECT_EQ(fault(command), kNotFinite) << k;
    }
  }
}

TEST(CommandCheckTest, RefusesWhatTheVehicleCannotDo) {
  EXPECT_EQ(fault(direct(50.1F)), kOutOfRange);
  EXPECT_EQ(fault(direct(-0.1F)), kOutOfRange) << "downwards";
  for (std::size_t k = 3; k < 6; ++k) {
    rosflight::OffboardControl command = direct(10.0F);
    command.u[k] = 2.1F;
    EXPECT_EQ(fault(command), kOutOfRange) << k;
  }
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{6}, std::size_t{9}}) {
    rosflight::OffboardControl command = direct(10.0F);
    command.u[k] = 0.1F;
    EXPECT_EQ(fault(command), kOutOfRange) << k;
  }
  EXPECT_EQ(fault({.u = {0, 0, 1.1F}, .mode = 1}), kOutOfRange);
  EXPECT_EQ(fault({.u = {0, 0, -0.1F}, .mode = 2}), kOutOfRange);
  EXPECT_EQ(fault({.u = {0, 0, 0.5F, 0.8F}, .mode = 2}), kOutOfRange);
  EXPECT_EQ(fault({.u = {0, 0, 0.5F, 3.1F}, .mode = 1}), kOutOfRange);
  EXPECT_EQ(fault({.u = {0, 0, 0.5F}, .mode = 3}), kUnknownMode);
}

TEST(CommandCheckTest, RefusesWhatAnswersOldSensorsOrOnesOfTheFuture) {
  CommandCheck check(kLimits);
  EXPECT_EQ(check.check({direct(1.0F), milliseconds(10), 1}, milliseconds(15)), kNone);
  EXPECT_EQ(check.check({direct(1.0F), milliseconds(10), 2}, milliseconds(16)), kStale);
  EXPECT_EQ(check.check({direct(1.0F), milliseconds(17), 3}, milliseconds(16)), kStale);
}

TEST(CommandCheckTest, PassesEachStepOfTheAutopilotOnce) {
  CommandCheck check(kLimits);
  const Time now = milliseconds(10);
  EXPECT_EQ(check.check({direct(1.0F), now, 5}, now), kNone);
  EXPECT_EQ(check.check({direct(1.0F), now, 5}, now), kRepeated);
  EXPECT_EQ(check.check({direct(1.0F), now, 4}, now), kRepeated);
  EXPECT_EQ(check.check({direct(1.0F), now, 6}, now), kNone);
}

}  // namespace
}  // namespace ironbird::hil_bridge
