#include "hil_bridge/executive/guard.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <thread>

#include "hil_bridge/executive/latest_value.hpp"
#include "hil_bridge/executive/test/live_guard.hpp"
#include "hil_bridge/serial_fcu/test/served_unit.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;
using test::kPeriod;
using enum InterlockState;
using test::LiveGuard;

autopilot::FcuCommand lift(double thrust = 20.0) {
  return autopilot::PassThroughCommand{.thrust = thrust};
}

TEST(GuardTest, LetsThroughTheLineOnlyWhatItHasJustApproved) {
  LiveGuard live;
  const auto approved = live.guard.answer(lift(), Time{}, kPeriod);
  ASSERT_TRUE(approved);
  rosflight::OffboardControl other = *approved;
  other.u[2] *= 2.0F;
  EXPECT_FALSE(live.guard.pass(other, kPeriod)) << "not what was approved";
  EXPECT_FALSE(live.guard.pass(*approved, kPeriod)) << "and the approval is used up";
  ASSERT_TRUE(live.guard.answer(lift(), kPeriod, 2 * kPeriod));
  EXPECT_TRUE(live.guard.pass(*approved, 2 * kPeriod));
  EXPECT_FALSE(live.guard.pass(*approved, 2 * kPeriod)) << "once";
}

TEST(GuardTest, SaysNothingWhereTheAutopilotIsSilentAndFindsNoFaultWithThat) {
  LiveGuard live;
  for (int k = 1; k < 400; ++k) {
    EXPECT_FALSE(live.guard.answer(autopilot::SilenceCommand{}, k * kPeriod, k * kPeriod));
    live.guard.step(test::good_estimate(), true, k * kPeriod);
  }
  EXPECT_EQ(live.guard.status().state, kLive);
}

TEST(GuardTest, KillsAnAutopilotThatCommandsNoNumbers) {
  LiveGuard live;
  int periods = 0;
  for (; live.guard.status().state == kLive && periods < 400; ++periods) {
    const Time now = periods * kPeriod;
    EXPECT_FALSE(live.guard.answer(lift(std::numeric_limits<double>::quiet_NaN()), now, now));
    live.guard.step(test::good_estimate(), true, now);
  }
  EXPECT_EQ(live.guard.status().why, "commands were refused for too long");
  EXPECT_EQ(periods, 21) << "half of the unit's time-out of 100 ms";
}

TEST(GuardTest, ClosesForGood) {
  LiveGuard live;
  ASSERT_TRUE(live.guard.answer(lift(), Time{}, Time{}));
  live.guard.close(kPeriod);
  EXPECT_EQ(live.guard.status().state, kKilled);
  EXPECT_FALSE(live.guard.pass(*std::make_optional(rosflight::OffboardControl{}), kPeriod));
  for (int k = 2; k < 100; ++k) {
    live.guard.step(test::good_estimate(), true, k * kPeriod);
    EXPECT_FALSE(live.guard.answer(lift(), k * kPeriod, k * kPeriod));
  }
}

TEST(GuardTest, TakesAStampOfTheNextMomentForNow) {
  LiveGuard live;
  EXPECT_TRUE(live.guard.answer(lift(), milliseconds(11), milliseconds(10)))
      << "what the clocks of unit and bench differ by, at most";
}

// ---- what is found out of a unit at the other end of a line ----

VirtualFcuConfig flyable() {
  VirtualFcuConfig config;
  config.parameters = {{"RC_NUM_CHN", 8},      {"RC_ARM_CHN", 4},    {"RC_ATT_OVRD_CHN", 5},
                       {"RC_THR_OVRD_CHN", 5}, {"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.3},
                       {"GYRO_X_BIAS", 1e-9}};
  return config;
}

class LineUnitWatchTest : public ::testing::Test {
 protected:
  InterlockInputs report() {
    InterlockInputs in;
    watch.report(link.now(), in);
    return in;
  }
  void tick(int count) {
    for (int k = 0; k < count; ++k) {
      link.tick();
      for (const Arrival& arrival : link.inbox()) watch.take(arrival);
    }
  }

  test::DeskLink link{0.0, 1, {}, flyable()};
  const ParameterRecord wanted{"FAILSAFE_THR", kRealParameter, std::bit_cast<std::uint32_t>(0.3F)};
  LineUnitWatch watch{link.fcu(), {wanted}};
};

TEST_F(LineUnitWatchTest, FindsASoundUnitSound) {
  EXPECT_FALSE(report().unit_known);
  tick(1200);
  const InterlockInputs in = report();
  EXPECT_TRUE(in.link_alive && in.unit_known && in.parameters_equal && in.sensors_flow && in.radio_present);
  EXPECT_TRUE(in.unit_disarmed && !in.unit_armed);
  EXPECT_TRUE(in.unit_faultless) << int{link.fcu().connection().status()->error_code};
  EXPECT_TRUE(watch.different().empty());
}

TEST_F(LineUnitWatchTest, SeesAParameterThatChangesAndOneThatChangesBack) {
  tick(1200);
  link.unit().send(test::setting("FAILSAFE_THR", 0.4F));
  tick(4);
  EXPECT_FALSE(report().parameters_equal);
  ASSERT_EQ(watch.different().size(), 1U);
  EXPECT_EQ(value_text(*watch.different().front().other), "0.4");
  link.unit().send(test::setting("FAILSAFE_THR", 0.3F));
  tick(4);
  EXPECT_TRUE(report().parameters_equal);
}

TEST_F(LineUnitWatchTest, LeavesParametersAloneThatTheScenarioDoesNotName) {
  tick(1200);
  link.unit().send(test::setting("MOTOR_IDLE_THR", 0.07F));
  tick(4);
  EXPECT_TRUE(report().parameters_equal);
}

TEST_F(LineUnitWatchTest, MissesARadioWithoutAnOverrideSwitch) {
  tick(1200);
  link.unit().send(test::setting("RC_THR_OVRD_CHN", -1));
  tick(4);
  EXPECT_FALSE(report().radio_present);
}

// The firmware listens to channels below RC_NUM_CHN only.
TEST_F(LineUnitWatchTest, MissesAnOverrideSwitchThatTheFirmwareDoesNotHear) {
  tick(1200);
  ASSERT_TRUE(report().radio_present);
  link.unit().send(test::setting("RC_THR_OVRD_CHN", 8));
  tick(4);
  EXPECT_FALSE(report().radio_present) << "of eight the last is 7";
  link.unit().send(test::setting("RC_THR_OVRD_CHN", 7));
  tick(4);
  EXPECT_TRUE(report().radio_present);
  link.unit().send(test::setting("RC_NUM_CHN", 7));
  tick(4);
  EXPECT_FALSE(report().radio_present);
}

TEST_F(LineUnitWatchTest, SeesAFailsafeAndAnErrorBit) {
  tick(1200);
  link.unit().host().pilot().lose();
  tick(50);
  EXPECT_FALSE(report().unit_faultless) << "the receiver says that the radio is lost";
}

TEST_F(LineUnitWatchTest, MissesEverythingOfALineThatIsCut) {
  tick(1200);
  link.pair().hang_up();
  link.fcu().advance(link.now());
  InterlockInputs in;
  watch.report(link.now(), in);
  EXPECT_FALSE(in.link_alive && in.unit_known);
}

// ---- from thread to thread ----

TEST(LatestValueTest, HandsOverWholeValuesAndNeverAnOlderOne) {
  struct Pair {
    std::uint64_t one = 0;
    std::uint64_t other = 0;
  };
  LatestValue<Pair> value;
  constexpr std::uint64_t kLast = 200'000;
  std::jthread writer([&] {
    for (std::uint64_t k = 1; k <= kLast; ++k) value.write({k, ~k});
  });
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const Pair& pair = value.read();
    if (pair.one == 0 && pair.other == 0) continue;  // nothing yet
    ASSERT_EQ(pair.other, ~pair.one);
    ASSERT_GE(pair.one, seen);
    seen = pair.one;
  }
}

}  // namespace
}  // namespace ironbird::hil_bridge
