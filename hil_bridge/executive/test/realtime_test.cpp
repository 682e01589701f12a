// The real-time executive, in a time that the test owns.

#include "hil_bridge/executive/realtime.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <deque>
#include <stdexcept>

#include "autopilot/modules.hpp"
#include "hil_bridge/executive/test/live_guard.hpp"

namespace ironbird::hil_bridge {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::kPeriod;

/// Says when the line has something: then, or at the end of the wait, it is.
class ScriptedClock final : public Clock {
 public:
  Time now() override { return now_ += reading; }
  void wait(int descriptor, Time until) override {
    waited_for = descriptor;
    waited_until = until;
    Time woken = until;
    if (!bytes_at.empty() && bytes_at.front() < until) {
      woken = bytes_at.front();
      bytes_at.pop_front();
    }
    now_ = std::max(now_, woken) + std::exchange(late, Time{});
  }

  std::deque<Time> bytes_at;
  Time late{};     ///< how much later than it should the next wait ends
  Time reading{};  ///< what passes between two looks at the clock
  int waited_for = 0;
  Time waited_until{};

 private:
  Time now_{};
};

class NamedLine final : public transport::ByteStream {
 public:
  std::size_t read(std::span<std::uint8_t>) override { return 0; }
  std::size_t write(std::span<const std::uint8_t> from) override { return from.size(); }
  bool is_up() const override { return number >= 0; }
  bool reopen() override { return true; }
  int descriptor() const override { return number; }
  std::string name() const override { return "line"; }
  int number = 7;
};

/// Delivers an IMU frame whenever the test wants one.
class OneFrameFcu final : public Fcu {
 public:
  void advance(Time now) override { now_ = now; }
  void receive(std::vector<Arrival>& out) override {
    if (!std::exchange(frame_ready, false)) return;
    const auto us = static_cast<std::uint64_t>(now_.count() / 1000);
    out.push_back({now_, rosflight::SmallImu{.time_boot_us = us, .zacc = -9.8F, .temperature = 300.0F}});
  }
  void send(const rosflight::Message& message) override { sent.push_back({now_, message}); }
  bool frame_ready = false;
  std::vector<Arrival> sent;

 private:
  Time now_{};
};

class RealtimeTest : public ::testing::Test {
 protected:
  Realtime make(RealtimeConfig config = {}) { return Realtime(fcu, pilot, live.guard, line, clock, config); }

  OneFrameFcu fcu;
  autopilot::Modules modules = autopilot::standard_modules();
  autopilot::Autopilot pilot{autopilot::AutopilotConfig{}, modules};
  test::LiveGuard live{test::wide_config(InterlockProfile::kBench)};
  NamedLine line;
  ScriptedClock clock;
};

TEST_F(RealtimeTest, RefusesAPeriodThatIsNoTime) {
  EXPECT_THROW(make({.period = Time{}}), std::invalid_argument);
  EXPECT_THROW(make({.greatest_missed = 0}), std::invalid_argument);
}

TEST_F(RealtimeTest, LooksOnceInEveryPeriodWhenTheLineIsSilent) {
  Realtime loop = make();
  EXPECT_EQ(loop.pass(), Time{});
  for (int k = 1; k <= 100; ++k) EXPECT_EQ(loop.pass(), k * kPeriod);
  EXPECT_EQ(loop.timing().missed, 0U);
}

TEST_F(RealtimeTest, WakesAsSoonAsTheLineHasSomethingAndAnswersInTheSamePass) {
  Realtime loop = make();
  loop.pass();
  clock.bytes_at = {microseconds(300)};
  fcu.frame_ready = true;
  EXPECT_EQ(loop.pass(), microseconds(300));
  EXPECT_TRUE(loop.stepped());
  EXPECT_EQ(clock.waited_for, 7);
  EXPECT_EQ(loop.pass(), microseconds(300) + kPeriod) << "a period from there";
}

/// A unit whose talk needs memory that nobody has touched before.
class GreedyFcu final : public Fcu {
 public:
  ~GreedyFcu() override {
    if (memory_ != MAP_FAILED) munmap(memory_, kSize);
  }
  void advance(Time) override {
    if (memory_ == MAP_FAILED)
      memory_ = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory_ != MAP_FAILED) static_cast<volatile char*>(memory_)[0] = 1;
  }
  void receive(std::vector<Arrival>&) override {}
  void send(const rosflight::Message&) override {}

 private:
  static constexpr std::size_t kSize = 4096;
  void* memory_ = MAP_FAILED;
};

TEST_F(RealtimeTest, CountsHowOftenATickWaitedForMemory) {
  Realtime loop = make();
  for (int k = 0; k < 10; ++k) loop.pass();
  const std::uint64_t warm = loop.timing().page_faults;
  for (int k = 0; k < 100; ++k) loop.pass();
  EXPECT_EQ(loop.timing().page_faults, warm) << "in a loop that is warm there are none";
  GreedyFcu greedy;
  Realtime other(greedy, pilot, live.guard, line, clock, {});
  other.pass();
  EXPECT_GE(other.timing().page_faults, 1U);
}

TEST_F(RealtimeTest, WaitsForTheLineThatThereIsNow) {
  Realtime loop = make();
  loop.pass();
  line.number = -1;
  loop.pass();
  EXPECT_EQ(clock.waited_for, -1);
}

TEST_F(RealtimeTest, ActsOnAKillWithinOnePeriodThoughNothingArrives) {
  Realtime loop = make();
  loop.pass();
  ASSERT_EQ(live.guard.status().state, InterlockState::kLive);
  const Time known = loop.now();
  live.watch.told.sensors_flow = false;
  loop.pass();
  EXPECT_EQ(live.guard.status().state, InterlockState::kKilled);
  ASSERT_EQ(fcu.sent.size(), 1U) << "profile bench: zeros";
  EXPECT_LE(fcu.sent.front().when - known, kPeriod);
  for (int k = 0; k < 10; ++k) loop.pass();
  EXPECT_EQ(fcu.sent.size(), 11U) << "again in each period";
}

TEST_F(RealtimeTest, CountsThePeriodsInWhichItDidNotLook) {
  Realtime loop = make();
  loop.pass();
  clock.late = microseconds(2400);
  loop.pass();
  EXPECT_EQ(loop.timing().missed, 0U) << "two passes nearly two periods apart";
  clock.late = microseconds(2600);
  loop.pass();
  EXPECT_EQ(loop.timing().missed, 1U);
  clock.late = milliseconds(10);
  loop.pass();
  EXPECT_EQ(loop.timing().missed, 5U);
  EXPECT_EQ(loop.timing().most_missed, 5U) << "in a row";
  loop.pass();
  clock.late = microseconds(2600);
  loop.pass();
  EXPECT_EQ(loop.timing().most_missed, 5U) << "a pass in time begins a new row";
}

TEST_F(RealtimeTest, KillsBeforeAnythingLeavesWhenItHasMissedTooMany) {
  Realtime loop = make({.greatest_missed = 4});
  loop.pass();
  clock.late = 4 * kPeriod - microseconds(1);
  loop.pass();
  EXPECT_TRUE(loop.in_time());
  ASSERT_EQ(live.guard.status().state, InterlockState::kLive);
  clock.late = kPeriod;  // the fourth in a row
  fcu.frame_ready = true;
  loop.pass();
  EXPECT_FALSE(loop.in_time());
  EXPECT_EQ(live.guard.status().state, InterlockState::kKilled);
  EXPECT_EQ(live.guard.status().why, "the control loop misses its period");
}

TEST_F(RealtimeTest, MeasuresEachStage) {
  clock.reading = microseconds(10);
  Realtime loop = make();
  loop.pass();
  fcu.frame_ready = true;
  loop.pass();
  const LoopTiming& timing = loop.timing();
  EXPECT_EQ(timing.step.count(), 1U);
  EXPECT_EQ(timing.step.greatest(), microseconds(10));
  EXPECT_EQ(timing.send.greatest(), microseconds(10));
  EXPECT_EQ(timing.receive.count(), 2U);
  EXPECT_EQ(timing.response.greatest(), microseconds(40)) << "receive, then before, step, send";
}

TEST(HistogramTest, KnowsItsQuantilesToABucket) {
  Histogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), Time{});
  for (int k = 1; k <= 100; ++k) histogram.add(microseconds(k));
  EXPECT_EQ(histogram.count(), 100U);
  EXPECT_EQ(histogram.greatest(), microseconds(100));
  const auto near = [](Time found, double expected) {
    EXPECT_GE(static_cast<double>(found.count()), expected * 1e3);
    EXPECT_LE(static_cast<double>(found.count()), expected * 1.26e3);
  };
  near(histogram.quantile(0.5), 50.0);
  near(histogram.quantile(0.9), 90.0);
  EXPECT_EQ(histogram.quantile(1.0), microseconds(100));
}

TEST(HistogramTest, HasRisingBucketsTenToADecade) {
  for (std::size_t k = 1; k + 1 < Histogram::kBuckets; ++k) {
    EXPECT_GT(Histogram::upper_bound(k), Histogram::upper_bound(k - 1));
    if (k >= 10) {
      EXPECT_EQ(Histogram::upper_bound(k) / 10, Histogram::upper_bound(k - 10));
    }
  }
  Histogram histogram;
  histogram.add(std::chrono::hours(1));
  EXPECT_EQ(histogram.counts().back(), 1U);
}

}  // namespace
}  // namespace ironbird::hil_bridge
