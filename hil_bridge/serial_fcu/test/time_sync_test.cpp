#include "hil_bridge/serial_fcu/time_sync.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ironbird::hil_bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Two clocks and a line between them.
class Clocks {
 public:
  Time start = milliseconds(7300);  // bench time at which the unit's clock was zero
  double drift = 0.0;               // of the bench against the unit

  Time fcu(Time bench) const {
    return Time(static_cast<std::int64_t>(static_cast<double>((bench - start).count()) / (1.0 + drift)));
  }
  void exchange(TimeSync& sync, Time bench, Time there, Time back) const {
    sync.exchange(bench, fcu(bench + there), bench + there + back);
  }
  double error_us(TimeSync& sync, Time bench) const {
    return 1e-3 * static_cast<double>((sync.to_bench(fcu(bench), Time::zero()) - bench).count());
  }
};

TEST(TimeSyncTest, GivesTheTimeOfArrivalBeforeTheFirstExchange) {
  TimeSync sync;
  EXPECT_FALSE(sync.state().valid);
  EXPECT_EQ(sync.to_bench(seconds(5), seconds(9)), seconds(9));
}

TEST(TimeSyncTest, IsExactForASteadyLineWithTwoEqualWays) {
  const Clocks clocks;
  TimeSync sync;
  for (int k = 0; k < 100; ++k) {
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), microseconds(300), microseconds(300));
  }
  EXPECT_NEAR(clocks.error_us(sync, seconds(18)), 0.0, 0.1);
  EXPECT_EQ(sync.state().least_round_trip, microseconds(600));
}

TEST(TimeSyncTest, IsWrongByHalfTheDifferenceOfTheTwoWays) {
  const Clocks clocks;
  TimeSync sync;
  for (int k = 0; k < 100; ++k) {
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), microseconds(100), microseconds(500));
  }
  EXPECT_NEAR(clocks.error_us(sync, seconds(18)), 200.0, 1.0);
}

TEST(TimeSyncTest, PaysNoAttentionToExchangesThatTookLong) {
  const Clocks clocks;
  TimeSync sync;
  std::mt19937 random(4);
  for (int k = 0; k < 300; ++k) {
    const bool slow = k % 2 == 1;
    const Time back = slow ? milliseconds(5 + static_cast<int>(random() % 100U)) : microseconds(300);
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), microseconds(300), back);
  }
  EXPECT_NEAR(clocks.error_us(sync, seconds(38)), 0.0, 1.0);
  EXPECT_EQ(sync.state().ignored, 150U);
}

TEST(TimeSyncTest, FollowsTwoCrystalsThatDiffer) {
  for (const double drift : {50e-6, -80e-6, 200e-6}) {
    Clocks clocks;
    clocks.drift = drift;
    TimeSync sync;
    std::mt19937 random(5);
    for (int k = 0; k < 600; ++k) {
      const Time bench = seconds(8) + milliseconds(100 * k);
      const auto jitter = [&] { return microseconds(200 + static_cast<int>(random() % 200U)); };
      clocks.exchange(sync, bench, jitter(), jitter());
      if (k <= 100) continue;
      EXPECT_NEAR(clocks.error_us(sync, bench + milliseconds(50)), 0.0, 100.0) << k;
    }
    EXPECT_NEAR(sync.state().drift, drift, 10e-6);
  }
}

TEST(TimeSyncTest, StaysWhereItIsWhenNoExchangeIsBelievedForLong) {
  const Clocks clocks;
  TimeSync sync;
  int k = 0;
  for (; k < 20; ++k) {  // a quick one, late by half a millisecond on the way there: wrong by a quarter
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), microseconds(500), Time{});
  }
  for (; k < 25; ++k) {
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), Time{}, microseconds(500));
  }
  for (; k < 80; ++k) {  // the next five seconds all are slow
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), milliseconds(2), milliseconds(2));
    EXPECT_NEAR(clocks.error_us(sync, seconds(8) + milliseconds(100 * k)), 0.0, 500.0) << k;
  }
}

TEST(TimeSyncTest, NeverRunsBackwardsWhateverTheLineDoes) {
  std::mt19937 random(6);
  std::exponential_distribution<double> delay(1.0 / 3e-3);
  for (int run = 0; run < 50; ++run) {
    Clocks clocks;
    clocks.drift = 1e-4 * (static_cast<double>(random() % 201U) / 100.0 - 1.0);
    TimeSync sync;
    Time before = Time::min();
    for (int tick = 0; tick < 8000; ++tick) {
      const Time bench = seconds(8) + microseconds(2500) * tick;
      if (tick % 40 == 0) {
        const auto way = [&] { return Time(static_cast<std::int64_t>(delay(random) * 1e9)); };
        clocks.exchange(sync, bench, way(), way());
      }
      const Time stamp = sync.to_bench(clocks.fcu(bench), bench);
      if (before != Time::min() && sync.state().valid && tick > 0) {
        ASSERT_GE(stamp, before) << "run " << run << ", tick " << tick;
        ASSERT_LE(stamp - before, microseconds(2510)) << "it slews, it does not jump";
      }
      before = stamp;
    }
  }
}

// A slow radio answers the first request behind eleven kilobytes of parameters.
TEST(TimeSyncTest, BelievesASlowFirstExchangeOnlyUntilOneThatProvesItWrong) {
  for (const bool slow_there : {true, false}) {
    const Clocks clocks;
    TimeSync sync;
    const Time slow = seconds(2);
    const Time quick = microseconds(300);
    clocks.exchange(sync, seconds(8), slow_there ? slow : quick, slow_there ? quick : slow);
    EXPECT_NEAR(std::abs(clocks.error_us(sync, milliseconds(10'310))), 1e6, 1e3);
    Time latest = Time::min();
    for (int k = 0; k < 30; ++k) {
      clocks.exchange(sync, milliseconds(10'350 + 100 * k), quick, quick);
      const Time stamp = sync.to_bench(clocks.fcu(milliseconds(10'360 + 100 * k)), Time::zero());
      EXPECT_GE(stamp, latest) << "never backwards";
      latest = stamp;
    }
    EXPECT_NEAR(clocks.error_us(sync, seconds(14)), 0.0, 1.0) << (slow_there ? "there" : "back");
  }
}

TEST(TimeSyncTest, BeginsAnewWhenTheUnitHasBooted) {
  Clocks clocks;
  TimeSync sync;
  for (int k = 0; k < 50; ++k) {
    clocks.exchange(sync, seconds(8) + milliseconds(100 * k), microseconds(300), microseconds(300));
  }
  sync.reset();
  EXPECT_FALSE(sync.state().valid);
  clocks.start = seconds(20);
  clocks.exchange(sync, seconds(21), microseconds(300), microseconds(300));
  EXPECT_NEAR(clocks.error_us(sync, seconds(21)), 0.0, 1.0);
}

}  // namespace
}  // namespace ironbird::hil_bridge
