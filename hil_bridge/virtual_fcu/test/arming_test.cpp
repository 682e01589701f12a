#include "hil_bridge/virtual_fcu/arming.hpp"

#include <gtest/gtest.h>

#include <string>

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

constexpr ArmingConditions kReady = {
    .throttle_low = true, .throttle_protected = true, .calibrate_gyro = false};

/// Brings a fresh state machine into a state by events alone.
Arming in(State state) {
  Arming arming;
  if (state == State::kInit) return arming;
  arming.handle(Event::kInitialized);
  if (state == State::kError) arming.set_error(kUncalibratedImu);
  if (state == State::kArmed || state == State::kFailsafe) arming.request_arm(kReady);
  if (state == State::kFailsafe) arming.handle(Event::kRcLost);
  if (state == State::kCalibrating) {
    arming.request_arm({.throttle_low = true, .throttle_protected = true, .calibrate_gyro = true});
  }
  return arming;
}

/// What a state machine looks like from outside.
struct View {
  State state;
  bool armed;
  bool failsafe;
  bool error;
  std::uint16_t errors;
  bool operator==(const View&) const = default;
};

View view(const Arming& arming) {
  return {arming.state(), arming.armed(), arming.failsafe(), arming.error(), arming.errors()};
}

struct Case {
  const char* name;
  State from;
  Event event;
  View expected;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class TransitionTest : public ::testing::TestWithParam<Case> {};

TEST_P(TransitionTest, LeadsToTheStateAndFlagsOfTheTable) {
  Arming arming = in(GetParam().from);
  ASSERT_EQ(arming.state(), GetParam().from);
  arming.handle(GetParam().event);
  EXPECT_TRUE(view(arming) == GetParam().expected)
      << "state " << static_cast<int>(arming.state()) << " armed " << arming.armed() << " failsafe "
      << arming.failsafe() << " error " << arming.error() << " bits " << arming.errors();
}

INSTANTIATE_TEST_SUITE_P(
    Rows, TransitionTest,
    ::testing::Values(
        Case{"InitInitialized",
             State::kInit,
             Event::kInitialized,
             {State::kPreflight, false, false, false, 0}},
        Case{"PreflightRcLost", State::kPreflight, Event::kRcLost, {State::kError, false, false, true, 4}},
        Case{"PreflightRcFound",
             State::kPreflight,
             Event::kRcFound,
             {State::kPreflight, false, false, false, 0}},
        Case{"PreflightError", State::kPreflight, Event::kError, {State::kError, false, false, true, 0}},
        Case{"PreflightDisarm",
             State::kPreflight,
             Event::kRequestDisarm,
             {State::kPreflight, false, false, false, 0}},
        Case{"ErrorRcLost", State::kError, Event::kRcLost, {State::kError, false, false, true, 0x24}},
        Case{"ErrorRcFound", State::kError, Event::kRcFound, {State::kError, false, false, true, 0x20}},
        Case{"ErrorNoError", State::kError, Event::kNoError, {State::kPreflight, false, false, false, 0x20}},
        Case{"ErrorDisarm", State::kError, Event::kRequestDisarm, {State::kError, false, false, true, 0x20}},
        Case{"CalibratingComplete",
             State::kCalibrating,
             Event::kCalibrationComplete,
             {State::kArmed, true, false, false, 0}},
        Case{"CalibratingFailed",
             State::kCalibrating,
             Event::kCalibrationFailed,
             {State::kPreflight, false, false, false, 0}},
        Case{
            "CalibratingRcLost", State::kCalibrating, Event::kRcLost, {State::kError, false, false, true, 4}},
        Case{"CalibratingError", State::kCalibrating, Event::kError, {State::kError, false, false, true, 0}},
        Case{"CalibratingDisarm",
             State::kCalibrating,
             Event::kRequestDisarm,
             {State::kCalibrating, false, false, false, 0}},
        Case{"ArmedRcLost", State::kArmed, Event::kRcLost, {State::kFailsafe, true, true, true, 4}},
        Case{"ArmedRcFound", State::kArmed, Event::kRcFound, {State::kArmed, true, false, false, 0}},
        Case{
            "ArmedDisarm", State::kArmed, Event::kRequestDisarm, {State::kPreflight, false, false, false, 0}},
        Case{"ArmedError", State::kArmed, Event::kError, {State::kArmed, true, false, true, 0}},
        Case{"ArmedNoError", State::kArmed, Event::kNoError, {State::kArmed, true, false, false, 0}},
        Case{"FailsafeRcFound", State::kFailsafe, Event::kRcFound, {State::kArmed, true, false, false, 0}},
        Case{"FailsafeError", State::kFailsafe, Event::kError, {State::kFailsafe, true, true, true, 4}},
        Case{"FailsafeNoError", State::kFailsafe, Event::kNoError, {State::kFailsafe, true, true, true, 4}},
        Case{"FailsafeDisarm",
             State::kFailsafe,
             Event::kRequestDisarm,
             {State::kError, false, true, true, 4}}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(ArmingTableTest, LeavesEveryUnlistedCellAlone) {
  int listed = 0;
  for (const auto& [state, state_name] : enumerators(State{})) {
    for (const auto& [event, event_name] : enumerators(Event{})) {
      const Transition step = transition(state, event);
      if (step.next != state || step.actions != kNothing) ++listed;
    }
  }
  EXPECT_EQ(listed, 20);  // the rows of the firmware's state machine
}

struct ArmCase {
  const char* name;
  State from;
  ArmingConditions conditions;
  ArmingReply reply;
  State to;
};

std::ostream& operator<<(std::ostream& out, const ArmCase& c) {
  return out << c.name;
}

class RequestArmTest : public ::testing::TestWithParam<ArmCase> {};

TEST_P(RequestArmTest, ChecksThrottleThenProtectionThenCalibration) {
  Arming arming = in(GetParam().from);
  EXPECT_EQ(arming.request_arm(GetParam().conditions), GetParam().reply);
  EXPECT_EQ(arming.state(), GetParam().to);
  EXPECT_EQ(arming.armed(), GetParam().to == State::kArmed || GetParam().to == State::kFailsafe);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, RequestArmTest,
    ::testing::Values(
        ArmCase{"Ready", State::kPreflight, {true, true, false}, ArmingReply::kArmed, State::kArmed},
        ArmCase{"ThrottleHigh",
                State::kPreflight,
                {false, false, true},
                ArmingReply::kThrottleHigh,
                State::kPreflight},
        ArmCase{"Unprotected",
                State::kPreflight,
                {true, false, true},
                ArmingReply::kUnprotected,
                State::kPreflight},
        ArmCase{"Calibrates",
                State::kPreflight,
                {true, true, true},
                ArmingReply::kCalibrating,
                State::kCalibrating},
        ArmCase{"WithError", State::kError, {true, true, false}, ArmingReply::kRefused, State::kError},
        ArmCase{"Already", State::kArmed, {true, true, false}, ArmingReply::kIgnored, State::kArmed},
        ArmCase{"InFailsafe", State::kFailsafe, {true, true, false}, ArmingReply::kIgnored, State::kFailsafe},
        ArmCase{"WhileCalibrating",
                State::kCalibrating,
                {true, true, false},
                ArmingReply::kIgnored,
                State::kCalibrating},
        ArmCase{"BeforeBoot", State::kInit, {true, true, false}, ArmingReply::kIgnored, State::kInit}),
    [](const auto& row) { return std::string(row.param.name); });

TEST(ArmingTest, GoesToErrorWhenDisarmedWithAnErrorInFlight) {
  Arming arming = in(State::kArmed);
  arming.set_error(kUnhealthyEstimator);
  EXPECT_EQ(arming.state(), State::kArmed);
  EXPECT_TRUE(arming.armed());
  arming.handle(Event::kRequestDisarm);
  EXPECT_EQ(arming.state(), State::kError);
  EXPECT_FALSE(arming.armed());
}

TEST(ArmingTest, LeavesErrorWithTheLastErrorBit) {
  Arming arming = in(State::kPreflight);
  arming.set_error(kInvalidMixer);
  arming.set_error(kInvalidFailsafe);
  arming.clear_error(kInvalidMixer);
  EXPECT_EQ(arming.state(), State::kError);
  arming.clear_error(kInvalidFailsafe);
  EXPECT_EQ(arming.state(), State::kPreflight);
  EXPECT_FALSE(arming.error());
}

TEST(ArmingTest, ReportsAChangeOnce) {
  Arming arming = in(State::kPreflight);
  EXPECT_TRUE(arming.take_change());
  EXPECT_FALSE(arming.take_change());
  arming.set_error(kInvalidMixer);
  EXPECT_TRUE(arming.take_change());
}

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
