#include "hil_bridge/interlock/interlock_state.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "hil_bridge/interlock/test/interlock_inputs.hpp"

namespace ironbird::hil_bridge {
namespace {

using enum InterlockState;
using test::kSwitches;
using test::sound;

InterlockInputs inputs_of(unsigned bits) {
  InterlockInputs in;
  for (std::size_t k = 0; k < kSwitches.size(); ++k) in.*kSwitches[k] = (bits >> k & 1U) != 0;
  return in;
}

InterlockState after(InterlockState state, const InterlockInputs& in) {
  const InterlockRow* const row = deciding_row(state, in);
  return row == nullptr ? state : row->to;
}

/// For every state and every combination of inputs.
template <class Check>
void for_every_cell(Check&& check) {
  for (const InterlockState state : kInterlockStates) {
    for (unsigned bits = 0; bits < 1U << kSwitches.size(); ++bits) {
      const InterlockInputs in = inputs_of(bits);
      check(state, in, after(state, in));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(InterlockStateTest, IsLiveOnlyAfterReleasedWithAnArmedUnitAndNothingMissing) {
  for_every_cell([](InterlockState before, const InterlockInputs& in, InterlockState now) {
    if (now != kLive) return;
    EXPECT_TRUE(before == kReleased || before == kLive);
    EXPECT_TRUE(in.unit_armed && !in.unit_disarmed && in.link_alive && in.unit_known && in.sensors_flow &&
                in.radio_present && in.parameters_equal && in.commands_sound && in.bench_in_time &&
                in.watchdog_awake && !in.kill_wanted);
  });
}

TEST(InterlockStateTest, IsReleasedOnlyByAnOperatorWithADisarmedUnitThatIsVerified) {
  for_every_cell([](InterlockState before, const InterlockInputs& in, InterlockState now) {
    if (now != kReleased || before == kReleased) return;
    EXPECT_EQ(before, kVerified);
    EXPECT_TRUE(in.release_wanted && in.unit_disarmed && !in.unit_armed && in.unit_faultless &&
                in.parameters_equal && in.radio_present && in.sensors_flow && in.estimate_usable &&
                in.link_alive && in.unit_known && in.bench_in_time && in.watchdog_awake);
  });
}

TEST(InterlockStateTest, LetsNoArmedUnitBeyondConnectedThatWasNotReleased) {
  for_every_cell([](InterlockState before, const InterlockInputs& in, InterlockState now) {
    if (before == kCold || before == kConnected || before == kVerified) {
      EXPECT_FALSE(in.unit_armed && !in.unit_disarmed &&
                   (now == kVerified || now == kReleased || now == kLive));
    }
  });
}

TEST(InterlockStateTest, LeavesKilledOnlyByAnOperatorWithADisarmedUnit) {
  for_every_cell([](InterlockState before, const InterlockInputs& in, InterlockState now) {
    if (before != kKilled || now == kKilled) return;
    EXPECT_EQ(now, kCold);
    EXPECT_TRUE(in.reset_wanted && in.unit_disarmed && !in.kill_wanted);
  });
}

TEST(InterlockStateTest, IsKilledByAnyTroubleOnceReleased) {
  for_every_cell([](InterlockState before, const InterlockInputs& in, InterlockState now) {
    if (before != kReleased && before != kLive) return;
    const bool trouble = in.kill_wanted || !in.link_alive || !in.unit_known || !in.sensors_flow ||
                         !in.radio_present || !in.parameters_equal || !in.commands_sound ||
                         !in.bench_in_time || !in.watchdog_awake || in.unit_armed == in.unit_disarmed ||
                         (before == kReleased && (!in.unit_faultless || !in.estimate_usable));
    EXPECT_EQ(now == kKilled, trouble);
  });
}

TEST(InterlockStateTest, IsKilledByTheOperatorFromEveryState) {
  for_every_cell([](InterlockState, const InterlockInputs& in, InterlockState now) {
    EXPECT_TRUE(!in.kill_wanted || now == kKilled);
  });
}

TEST(InterlockStateTest, UsesEveryRow) {
  std::set<const InterlockRow*> used;
  for (const InterlockState state : kInterlockStates) {
    for (unsigned bits = 0; bits < 1U << kSwitches.size(); ++bits) {
      if (const InterlockRow* const row = deciding_row(state, inputs_of(bits))) used.insert(row);
    }
  }
  for (const InterlockRow& row : interlock_rows()) EXPECT_TRUE(used.contains(&row)) << row.name;
}

TEST(InterlockStateTest, GoesFromColdToLiveAndBack) {
  InterlockInputs in = sound();
  EXPECT_EQ(after(kCold, in), kConnected);
  EXPECT_EQ(after(kConnected, in), kVerified);
  EXPECT_EQ(after(kVerified, in), kVerified);
  in.release_wanted = true;
  EXPECT_EQ(after(kVerified, in), kReleased);
  in.release_wanted = false;
  EXPECT_EQ(after(kReleased, in), kReleased);
  in.unit_disarmed = false;
  in.unit_armed = true;
  EXPECT_EQ(after(kReleased, in), kLive);
  in.unit_faultless = false;
  EXPECT_EQ(after(kLive, in), kLive) << "an error bit in the air is no reason to stop flying";
  in = sound();
  EXPECT_EQ(after(kLive, in), kVerified) << "each flight is released anew";
}

}  // namespace
}  // namespace ironbird::hil_bridge
