#include "hil_bridge/executive/pace.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;

constexpr Time kTooLong = Pace::kGivenUp + milliseconds(100);

/// How long it takes to wait from 0 to `until` in steps of 5 ms, by the clock of the wall.
Time duration(Pace& pace, Time until) {
  const auto start = std::chrono::steady_clock::now();
  for (Time now{}; now <= until; now += milliseconds(5)) pace.wait(now);
  return std::chrono::steady_clock::now() - start;
}

TEST(PaceTest, IsNoFasterThanTheClockOrTheShareOfItThatIsAskedFor) {
  Pace real(1.0);
  EXPECT_GE(duration(real, milliseconds(100)), milliseconds(100));
  Pace slow(0.25);
  EXPECT_GE(duration(slow, milliseconds(50)), milliseconds(200));
}

TEST(PaceTest, GivesUpAGreatDelayAndBeginsTheClockAnew) {
  Pace pace(1.0);
  pace.wait(Time{});
  std::this_thread::sleep_for(kTooLong);
  pace.wait(milliseconds(5));
  EXPECT_GE(pace.lost(), Pace::kGivenUp);
  const auto start = std::chrono::steady_clock::now();
  pace.wait(milliseconds(55));
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(40));
}

TEST(PaceTest, SaysWhatItHasLostInTheRunsTime) {
  Pace pace(0.5);
  EXPECT_EQ(pace.wait(Time{}), Time::zero());
  std::this_thread::sleep_for(kTooLong);
  EXPECT_GE(pace.wait(milliseconds(10)), Pace::kGivenUp / 2);
  EXPECT_EQ(pace.wait(milliseconds(10)), Time::zero()) << "once";
}

TEST(PaceTest, RefusesToBeFasterThanTheClock) {
  EXPECT_THROW(Pace(1.5), std::invalid_argument);
  EXPECT_THROW(Pace(0.0), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::hil_bridge
