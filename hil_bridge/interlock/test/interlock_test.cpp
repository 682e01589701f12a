#include "hil_bridge/interlock/interlock.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "hil_bridge/interlock/test/interlock_inputs.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using enum InterlockState;
using test::kSwitches;
using test::sound;

constexpr Time kPeriod = microseconds(2500);

InterlockConfig config(InterlockProfile profile) {
  return {.profile = profile,
          .limits = {.thrust = 50.0, .torque = 2.0, .angle = 0.7, .rate = 3.0, .greatest_age = 2 * kPeriod}};
}

/// Asks for no thrust, torque, rate or angle.
bool is_zero(const rosflight::OffboardControl& command) {
  return command.u == rosflight::OffboardControl{}.u;
}

rosflight::OffboardControl lift() {
  return {.u = {0, 0, -20.0F, 0.1F}, .ignore = 0, .mode = 0};
}

/// A bench that has been through everything and flies.
class Flight {
 public:
  explicit Flight(InterlockProfile profile) : interlock(config(profile)) {
    step();
    step();
    in.release_wanted = true;
    step();
    in.release_wanted = false;
    in.unit_disarmed = false;
    in.unit_armed = true;
    step();
  }
  void step() {
    now += kPeriod;
    interlock.step(in, now);
  }
  std::optional<rosflight::OffboardControl> command(const rosflight::OffboardControl& wanted) {
    return interlock.command({wanted, now, ++number}, now);
  }

  Interlock interlock;
  InterlockInputs in = sound();
  Time now{};
  std::uint64_t number = 0;
};

TEST(InterlockTest, PassesCommandsInLiveAndNothingBefore) {
  Interlock interlock(config(InterlockProfile::kFlight));
  EXPECT_FALSE(interlock.command({lift(), Time{}, 1}, Time{}));
  Flight flight(InterlockProfile::kFlight);
  ASSERT_EQ(flight.interlock.status().state, kLive);
  const auto passed = flight.command(lift());
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->u, lift().u);
}

TEST(InterlockTest, SendsZerosWhileReleasedSoThatTheUnitKnowsItsCompanion) {
  Interlock interlock(config(InterlockProfile::kFlight));
  InterlockInputs in = sound();
  interlock.step(in, kPeriod);
  interlock.step(in, 2 * kPeriod);
  EXPECT_FALSE(interlock.command({lift(), 2 * kPeriod, 1}, 2 * kPeriod)) << "verified";
  in.release_wanted = true;
  interlock.step(in, 3 * kPeriod);
  ASSERT_EQ(interlock.status().state, kReleased);
  const auto passed = interlock.command({lift(), 3 * kPeriod, 2}, 3 * kPeriod);
  ASSERT_TRUE(passed);
  EXPECT_TRUE(is_zero(*passed));
}

TEST(InterlockTest, KillsToZerosOnTheBenchAndToSilenceInTheAir) {
  for (const InterlockProfile profile : {InterlockProfile::kBench, InterlockProfile::kFlight}) {
    Flight flight(profile);
    flight.in.kill_wanted = true;
    flight.step();
    flight.in.kill_wanted = false;
    for (int k = 0; k < 100; ++k) {
      flight.step();
      EXPECT_EQ(flight.interlock.status().state, kKilled);
      const auto passed = flight.command(lift());
      EXPECT_EQ(passed.has_value(), profile == InterlockProfile::kBench);
      EXPECT_TRUE(!passed || is_zero(*passed));
    }
    EXPECT_EQ(flight.interlock.status().why, "the operator killed");
  }
}

TEST(InterlockTest, DropsSingleBadCommandsAndKillsWhenTheyDoNotEnd) {
  Flight flight(InterlockProfile::kFlight);
  rosflight::OffboardControl bad = lift();
  bad.u[2] = std::numeric_limits<float>::quiet_NaN();
  for (int k = 0; k < 20; ++k) {
    flight.step();
    EXPECT_TRUE(flight.command(lift()));
    EXPECT_FALSE(flight.command(bad));
  }
  EXPECT_EQ(flight.interlock.status().state, kLive);
  int periods = 0;
  for (; flight.interlock.status().state == kLive; ++periods) {
    flight.step();
    flight.command(bad);
  }
  EXPECT_EQ(periods, 21) << "half of the unit's time-out of 100 ms";
  EXPECT_EQ(flight.interlock.status().why, "commands were refused for too long");
  EXPECT_GE(flight.interlock.status().refused[static_cast<std::size_t>(CommandFault::kNotFinite)], 39U);
}

TEST(InterlockTest, PassesNoMotorCommandThatHasNoStamp) {
  Flight flight(InterlockProfile::kFlight);
  EXPECT_FALSE(flight.interlock.pass(lift(), flight.now));
  EXPECT_FALSE(flight.interlock.pass(rosflight::RosflightAuxCmd{}, flight.now));
  EXPECT_TRUE(flight.interlock.pass(rosflight::Heartbeat{}, flight.now));
  EXPECT_TRUE(flight.interlock.pass(rosflight::Timesync{}, flight.now));
  EXPECT_TRUE(flight.interlock.pass(rosflight::ParamRequestList{}, flight.now));
}

TEST(InterlockTest, ChangesTheUnitOnlyWhileItIsDisarmedAndNotReleased) {
  Interlock interlock(config(InterlockProfile::kBench));
  const auto passes = [&](std::uint8_t command) {
    return interlock.pass(rosflight::RosflightCmd{command}, Time{}).has_value();
  };
  InterlockInputs in = sound();
  EXPECT_FALSE(interlock.pass(rosflight::ParamSet{}, Time{})) << "nobody knows yet whether it is armed";
  EXPECT_TRUE(passes(10)) << "its version may always be asked";
  interlock.step(in, kPeriod);
  EXPECT_TRUE(interlock.pass(rosflight::ParamSet{}, Time{}));
  for (std::uint8_t command = 0; command < 10; ++command) EXPECT_TRUE(passes(command));
  in.release_wanted = true;
  interlock.step(in, 2 * kPeriod);
  interlock.step(in, 3 * kPeriod);
  ASSERT_EQ(interlock.status().state, kReleased);
  EXPECT_FALSE(interlock.pass(rosflight::ParamSet{}, Time{}));
  for (std::uint8_t command = 0; command < 10; ++command) EXPECT_FALSE(passes(command));
  Interlock other(config(InterlockProfile::kBench));
  in = sound();
  in.unit_armed = true;
  other.step(in, kPeriod);
  EXPECT_FALSE(other.pass(rosflight::ParamSet{}, Time{})) << "it contradicts itself";
}

/// What must have happened before a motor may turn, watched from outside.
class Witness {
 public:
  void see(const InterlockInputs& in) {
    const bool well = in.link_alive && in.unit_known && in.parameters_equal && in.sensors_flow &&
                      in.radio_present && in.commands_sound && in.bench_in_time && in.watchdog_awake &&
                      !in.kill_wanted;
    const bool ready = well && in.unit_disarmed && !in.unit_armed && in.unit_faultless && in.estimate_usable;
    if (!well) released_ = flew_ = false;
    if (released_ && flew_ && in.unit_disarmed) released_ = flew_ = false;
    if (ready && in.release_wanted) released_ = true;
    if (released_ && in.unit_armed && !in.unit_disarmed) flew_ = true;
    may_turn_ = released_ && in.unit_armed && !in.unit_disarmed && well;
  }
  bool may_turn() const { return may_turn_; }

 private:
  bool released_ = false;
  bool flew_ = false;
  bool may_turn_ = false;
};

/// Ten million events, each of which turns one switch, most often back to what lets things go on.
TEST(InterlockTest, TurnsNoMotorOutsideLiveWhateverHappens) {
  std::mt19937 random(10);
  Interlock interlock(config(InterlockProfile::kBench));
  InterlockInputs in = sound();
  Witness witness;
  Time now{};
  std::uint64_t number = 0;
  std::uint64_t turned = 0;
  std::array<std::uint64_t, kInterlockStates.size()> visits{};
  for (int event = 0; event < 10'000'000; ++event) {
    const std::uint32_t any = random();
    const std::size_t which = any % kSwitches.size();
    in.*kSwitches[which] = (any >> 8U) % 4U == 0U;
    if ((any >> 10U) % 4U != 0U) {  // the world mostly mends itself
      const bool armed = (any >> 12U) % 2U == 0U;
      const bool release = in.release_wanted;
      const bool reset = in.reset_wanted;
      in = sound();
      in.unit_armed = armed;
      in.unit_disarmed = !armed;
      in.release_wanted = release;
      in.reset_wanted = reset;
    }
    now += kPeriod;
    interlock.step(in, now);
    witness.see(in);
    const auto passed = interlock.command({lift(), now, ++number}, now);
    ++visits[static_cast<std::size_t>(interlock.status().state)];
    if (!passed || is_zero(*passed)) continue;
    ++turned;
    ASSERT_EQ(interlock.status().state, kLive) << "event " << event;
    ASSERT_TRUE(witness.may_turn()) << "event " << event;
  }
  EXPECT_GT(turned, 10'000U) << "the walk flies often enough to mean something";
  for (const std::uint64_t count : visits) EXPECT_GT(count, 10'000U);
}

}  // namespace
}  // namespace ironbird::hil_bridge
