// The bench of real runs against a served unit, in a time that the test owns. docs/safety.md, R4 to R7, R12.

#include "scenarios/bench/live_bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scenarios/bench/test/live_rig.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::InterlockState;
using hil_bridge::transport::LinkError;
using std::chrono::milliseconds;
using test::LiveRig;
using test::Time;
using enum InterlockState;

constexpr Time kPeriod = std::chrono::microseconds(2500);

TEST(LiveBenchTest, FliesThePapersMissionAndJudgesItWithoutTruth) {
  LiveRig rig;
  ASSERT_TRUE(rig.until(200.0, [&] { return rig.bench().ended(); }));
  const Verdict verdict = rig.bench().finish(0.0);
  EXPECT_EQ(verdict.outcome, Outcome::kPass) << (verdict.reasons.empty() ? "" : verdict.reasons.front());
  int not_judged = 0;
  for (const CheckResult& check : verdict.checks) {
    if (check.outcome != Outcome::kNotJudged) continue;
    ++not_judged;
    EXPECT_EQ(check.explanation, "no truth on a real vehicle");
    EXPECT_EQ(check.name, "true path error, calm");
  }
  EXPECT_EQ(not_judged, 1);
}

TEST(LiveBenchTest, TellsEachStateOfTheInterlockAsAnEventWithItsReason) {
  LiveRig rig;
  ASSERT_TRUE(rig.live_within(8.0));
  rig.bench().pass();
  rig.bench().stop();
  rig.bench().pass();
  std::vector<std::string> told;
  for (const RunEvent& event : rig.bench().finish(0.0).events) {
    if (event.kind == "interlock") told.push_back(event.text);
  }
  EXPECT_EQ(told,
            (std::vector<std::string>{"connected: version and parameters are known",
                                      "verified: everything is as the scenario wants it",
                                      "released: the operator released the run", "live: the pilot armed"}));
}

TEST(LiveBenchTest, SendsNoMotorCommandBeforeThePilotHasArmed) {
  LiveRig rig;
  rig.there().arm_at = std::chrono::seconds(10);
  rig.until(9.9, [] { return false; });
  EXPECT_EQ(rig.state(), kReleased);
  EXPECT_EQ(rig.there().unit().greatest_force, 0.0F);
}

TEST(LiveBenchTest, IsNotReleasedWithoutAnOperatorsWord) {
  LiveRig rig;
  rig.options.released = false;
  rig.there().arm_at = std::chrono::seconds(20);
  rig.until(8.0, [] { return false; });
  EXPECT_EQ(rig.state(), kVerified);
  rig.bench().release();
  EXPECT_TRUE(rig.until(0.1, [&] { return rig.state() == kReleased; }));
}

TEST(LiveBenchTest, NeverFliesAUnitThatWasFoundArmed) {
  LiveRig rig;
  rig.there().arm_at = milliseconds(0);
  rig.there().fcu().pilot().arm(true);
  rig.options.meeting_patience = 20.0;
  rig.until(15.0, [] { return false; });
  EXPECT_LT(rig.state(), kVerified);
  EXPECT_EQ(rig.there().unit().commands, 0);
}

TEST(LiveBenchTest, AsksForTakeOffUntilThePilotHandsOver) {
  LiveRig rig;
  rig.there().hands_over = false;
  ASSERT_TRUE(rig.live_within(8.0));
  EXPECT_FALSE(rig.flies_within(5.0));
  EXPECT_TRUE(rig.bench().view().waits_for_pilot);
  rig.there().hands_over = true;
  EXPECT_TRUE(rig.flies_within(5.0));
}

struct KillCase {
  const char* name;
  void (*harm)(LiveRig&);
  Time noticed;  ///< after so long it must be killed, to one period
  const char* why;
  bool held_for_ever =
      false;  ///< docs/safety.md, C5: without radio frames the unit takes nothing up, no silence either
};

class KillTest : public ::testing::TestWithParam<KillCase> {};

TEST_P(KillTest, KillsAFlyingVehicleWithinOnePeriodOfKnowing) {
  LiveRig rig;
  ASSERT_TRUE(rig.flies_within(15.0));
  GetParam().harm(rig);
  const Time harmed = rig.there().now();
  ASSERT_TRUE(rig.until(5.0, [&] { return rig.state() == kKilled; }));
  EXPECT_EQ(rig.bench().interlock().why, GetParam().why);
  // What was heard last came up to one of its own periods before the harm.
  EXPECT_LE(rig.there().now() - harmed, GetParam().noticed + 2 * kPeriod);
  // THEN the line falls silent, and the unit lets the pilot have the vehicle within 150 ms.
  const int sent = rig.there().unit().commands;
  rig.pass_for(milliseconds(150), [] { return false; });
  EXPECT_LE(rig.there().unit().commands, sent + 1) << "one may have been under way";
  EXPECT_TRUE(GetParam().held_for_ever || !rig.there().firmware().commands().offboard());
}

TEST_P(KillTest, MakesTheRunInvalidWithTheReason) {
  LiveRig rig;
  ASSERT_TRUE(rig.flies_within(15.0));
  GetParam().harm(rig);
  ASSERT_TRUE(rig.until(20.0, [&] { return rig.bench().ended(); }));
  const Verdict verdict = rig.bench().finish(0.0);
  EXPECT_EQ(verdict.outcome, Outcome::kInvalid);
  ASSERT_EQ(verdict.reasons.size(), 1U);
  EXPECT_TRUE(verdict.reasons.front().ends_with(GetParam().why)) << verdict.reasons.front();
}

const KillCase kKillCases[] = {
    {"HangUp", [](LiveRig& rig) { rig.line.hang_up(); }, Time{},
     "the unit began anew: it booted, its line was cut, or another one speaks"},
    {"ImuSilence", [](LiveRig& rig) { rig.there().unit().mute<test::rosflight::SmallImu>(); },
     milliseconds(50), "no IMU data for 50 ms"},
    {"RadioSilence", [](LiveRig& rig) { rig.there().fcu().pilot().fall_silent(); }, milliseconds(100),
     "no radio frames for 100 ms", true},
    {"HeartbeatSilence", [](LiveRig& rig) { rig.there().unit().mute<test::rosflight::Heartbeat>(); },
     std::chrono::seconds(3), "the unit is not heard any more"},
    {"StatusSilence", [](LiveRig& rig) { rig.there().unit().mute<test::rosflight::RosflightStatus>(); },
     milliseconds(500), "the unit does not say whether it is armed"},
    {"ParameterChanged",
     [](LiveRig& rig) {
       rig.there().fcu().send(
           test::rosflight::ParamSet{.param_value = {std::bit_cast<std::uint32_t>(0.3F)},
                                     .target_system = 1,
                                     .param_id = test::rosflight::field_of<16>("FAILSAFE_THR"),
                                     .param_type = hil_bridge::kRealParameter});
     },
     milliseconds(10), "a parameter of the unit has changed"},
    {"Boot", [](LiveRig& rig) { rig.there().boot(); }, Time{},
     "the unit began anew: it booted, its line was cut, or another one speaks"},
    {"MissedPeriods", [](LiveRig& rig) { rig.there().stalled = milliseconds(54); }, milliseconds(54),
     "the control loop misses its period"},
};

INSTANTIATE_TEST_SUITE_P(Harms, KillTest, ::testing::ValuesIn(kKillCases),
                         [](const auto& kill) { return kill.param.name; });

// docs/safety.md, C10.
TEST(LiveBenchTest, NeverCommandsAUnitThatBootedInFlightAndArmsAgain) {
  LiveRig rig(LiveRig::Settings{{"interlock.profile", "bench"}});
  ASSERT_TRUE(rig.flies_within(15.0));
  test::BootedUnit& booted = rig.there().boot();
  ASSERT_TRUE(rig.until(0.1, [&] { return rig.state() == kKilled; }));
  rig.there().unit().greatest_force = 0.0F;
  const auto armed = [&] { return booted.host().firmware().arming().armed(); };
  ASSERT_TRUE(rig.pass_for(std::chrono::seconds(60), armed)) << "it never armed again";
  rig.pass_for(std::chrono::seconds(4), [] { return false; });
  EXPECT_TRUE(armed());
  EXPECT_EQ(rig.state(), kKilled);
  EXPECT_EQ(rig.there().unit().greatest_force, 0.0F);
}

TEST(LiveBenchTest, SendsZerosAfterAKillOnTheBenchEveryPeriod) {
  LiveRig rig(LiveRig::Settings{{"interlock.profile", "bench"}});
  ASSERT_TRUE(rig.flies_within(15.0));
  rig.there().unit().mute<test::rosflight::SmallImu>();
  ASSERT_TRUE(rig.until(1.0, [&] { return rig.state() == kKilled; }));
  const int sent = rig.there().unit().commands;
  rig.until(0.1, [] { return false; });
  EXPECT_GE(rig.there().unit().commands, sent + 38);
  EXPECT_EQ(rig.there().unit().last_command.u, test::rosflight::OffboardControl{}.u);
}

TEST(LiveBenchTest, OutlivesASlipOfTheMachineThatIsShort) {
  LiveRig rig;
  ASSERT_TRUE(rig.flies_within(15.0));
  rig.there().stalled = milliseconds(15);
  rig.until(1.0, [] { return false; });
  EXPECT_EQ(rig.state(), kLive);
  EXPECT_EQ(rig.bench().timing().most_missed, 5U);
  const Verdict verdict = rig.bench().finish(0.0);
  ASSERT_TRUE(verdict.timing);
  EXPECT_EQ(verdict.timing->passes, rig.bench().timing().passes);
  EXPECT_EQ(verdict.timing->missed, rig.bench().timing().missed);
  EXPECT_EQ(verdict.timing->most_missed, 5U);
  EXPECT_EQ(verdict.timing->page_faults, rig.bench().timing().page_faults);
}

TEST(LiveBenchTest, ClosesTheGateWhenItIsStopped) {
  LiveRig rig;
  ASSERT_TRUE(rig.flies_within(15.0));
  rig.bench().stop();
  rig.bench().pass();
  ASSERT_TRUE(rig.bench().ended());
  rig.bench().close_gate();
  EXPECT_EQ(rig.state(), kKilled);
  const int sent = rig.there().unit().commands;
  for (int k = 0; k < 40; ++k) rig.bench().pass();
  EXPECT_LE(rig.there().unit().commands, sent + 1) << "one may have been under way";
}

TEST(LiveBenchTest, RefusesAUnitWithOtherParametersAndSaysHowToPushThem) {
  LiveRig rig;
  for (auto& parameter : rig.unit_scenario.fcu.parameters) {
    if (parameter.name == "FAILSAFE_THR") parameter.value = 0.3;
  }
  try {
    rig.until(5.0, [] { return false; });
    FAIL() << "it flew";
  } catch (const LinkError& error) {
    const std::string text = error.what();
    EXPECT_NE(
        text.find("1 parameter of the unit is not the scenario's:\n  FAILSAFE_THR is 0.3, must be 0.48"),
        std::string::npos)
        << text;
    EXPECT_NE(text.find("ironbird fcu params --port /dev/none set FAILSAFE_THR 0.48 --keep"),
              std::string::npos);
  }
}

TEST(LiveBenchTest, GivesUpOnALineOnWhichNothingIsHeard) {
  LiveRig rig;
  rig.options.meeting_patience = 0.5;
  rig.line.far().read({});
  for (std::size_t kind = 0; kind < 32; ++kind) rig.there().unit().muted.insert(kind);
  EXPECT_THROW(rig.until(2.0, [] { return false; }), LinkError);
}

TEST(LiveBenchTest, SaysWhatIsMissingWhenTheUnitDoesNotBecomeReady) {
  LiveRig rig;
  rig.options.verified_patience = 4.0;
  rig.there().unit().mute<test::rosflight::RcChannels>();
  try {
    rig.until(6.0, [] { return false; });
    FAIL() << "it waited on";
  } catch (const LinkError& error) {
    EXPECT_NE(std::string(error.what()).find("no radio frames"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ironbird::scenarios
