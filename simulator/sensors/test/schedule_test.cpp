#include "simulator/sensors/schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace ironbird::simulator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr Time kTick = microseconds(2500);

TEST(SamplePeriodTest, IsAWholeNumberOfTicks) {
  EXPECT_EQ(sample_period(400.0, kTick, "imu.rate"), microseconds(2500));
  EXPECT_EQ(sample_period(100.0, kTick, "mag.rate"), milliseconds(10));
  EXPECT_EQ(sample_period(10.0, kTick, "gnss.rate"), milliseconds(100));
  EXPECT_EQ(sample_period(133.3333, kTick, "x.rate"), microseconds(7500));
}

TEST(SamplePeriodTest, RefusesOtherRatesAndNamesTheTwoNearest) {
  try {
    sample_period(150.0, kTick, "sensors.magnetometer.timing.rate");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("sensors.magnetometer.timing.rate = 150 Hz"));
    EXPECT_THAT(refusal.what(), HasSubstr("200 Hz or 133.333 Hz"));
  }
}

TEST(SamplePeriodTest, RefusesRatesAboveTheTicks) {
  try {
    sample_period(1000.0, kTick, "imu.rate");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("imu.rate = 1000 Hz"));
    EXPECT_THAT(refusal.what(), HasSubstr("take 400 Hz"));
  }
}

TEST(SamplePeriodTest, AcceptsTheRatesThatItsOwnMessageNames) {
  EXPECT_EQ(sample_period(133.333, kTick, "x"), microseconds(7500));
  EXPECT_EQ(sample_period(57.1429, kTick, "x"), microseconds(17500));
}

TEST(SampleClockTest, IsDueOnceAtEveryMultipleOfItsPeriod) {
  SampleClock clock(milliseconds(10));
  std::vector<int> due;
  for (int tick = 1; tick <= 16; ++tick) {
    if (clock.due(tick * kTick)) due.push_back(tick);
  }
  EXPECT_EQ(due, (std::vector<int>{4, 8, 12, 16}));
}

TEST(DelayLineTest, DeliversEachReadingExactlyWhenItIsDue) {
  DelayLine<int> line;
  for (int tick = 1; tick <= 100; ++tick) {
    line.push((tick + 3) * kTick, tick);
    std::optional<int> out;
    line.pop(tick * kTick, out);
    if (tick <= 3) {
      EXPECT_FALSE(out);
    } else {
      EXPECT_EQ(out, tick - 3);
    }
  }
}

TEST(DelayLineTest, KeepsTheLastOfSeveralThatAreDue) {
  DelayLine<int> line;
  line.push(milliseconds(1), 1);
  line.push(milliseconds(2), 2);
  line.push(milliseconds(9), 3);
  std::optional<int> out;
  line.pop(milliseconds(5), out);
  EXPECT_EQ(out, 2);
}

TEST(LatencyTest, IsRoundedToWholeTicks) {
  EXPECT_EQ(whole_ticks(0.1, kTick), milliseconds(100));
  EXPECT_EQ(whole_ticks(0.0, kTick), Time::zero());
  EXPECT_EQ(whole_ticks(0.003, kTick), microseconds(2500));
  EXPECT_EQ(whole_ticks(0.004, kTick), microseconds(5000));
}

}  // namespace
}  // namespace ironbird::simulator
