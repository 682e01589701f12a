#include "hil_bridge/executive/paced_fcu.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace ironbird::hil_bridge {
namespace {

using std::chrono::milliseconds;

/// Takes its time now and then.
class Idle final : public Fcu {
 public:
  void advance(Time now) override {
    at = now;
    if (slow > Time::zero()) std::this_thread::sleep_for(slow);
    slow = {};
  }
  void receive(std::vector<Arrival>&) override {}
  void send(const rosflight::Message&) override {}

  Time at{};
  Time slow{};
};

/// How long it takes to advance from 0 to `until` in steps of 5 ms, by the clock of the wall.
Time duration(PacedFcu& fcu, Time until) {
  const auto start = std::chrono::steady_clock::now();
  for (Time now{}; now <= until; now += milliseconds(5)) fcu.advance(now);
  return std::chrono::steady_clock::now() - start;
}

TEST(PacedFcuTest, RunsNoFasterThanTheClockOrTheShareOfItThatIsAskedFor) {
  Idle idle;
  PacedFcu real(idle, 1.0);
  EXPECT_GE(duration(real, milliseconds(100)), milliseconds(100));
  EXPECT_EQ(idle.at, milliseconds(100));
  PacedFcu slow(idle, 0.25);
  EXPECT_GE(duration(slow, milliseconds(50)), milliseconds(200));
}

TEST(PacedFcuTest, CatchesUpWithASmallDelayAndGivesUpAGreatOne) {
  Idle idle;
  PacedFcu fcu(idle, 1.0);
  fcu.advance(Time{});
  idle.slow = PacedFcu::kGivenUp + milliseconds(100);
  fcu.advance(milliseconds(5));
  fcu.advance(milliseconds(10));
  EXPECT_GE(fcu.lost(), PacedFcu::kGivenUp);
  const auto start = std::chrono::steady_clock::now();
  fcu.advance(milliseconds(60));
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(40)) << "the clock begins anew";
}

TEST(PacedFcuTest, SaysWhatItHasLostInTheRunsTime) {
  Idle idle;
  PacedFcu fcu(idle, 0.5);
  EXPECT_EQ(fcu.wait(Time{}), Time::zero());
  EXPECT_EQ(fcu.wait(milliseconds(5)), Time::zero());
  std::this_thread::sleep_for(PacedFcu::kGivenUp + milliseconds(100));
  EXPECT_GE(fcu.wait(milliseconds(10)), PacedFcu::kGivenUp / 2);
  EXPECT_EQ(fcu.wait(milliseconds(10)), Time::zero()) << "once";
  idle.slow = PacedFcu::kGivenUp + milliseconds(100);
  fcu.advance(milliseconds(10));
  fcu.advance(milliseconds(15));
  EXPECT_GE(fcu.wait(milliseconds(20)), PacedFcu::kGivenUp / 2) << "also what was lost while it advanced";
}

TEST(PacedFcuTest, RefusesToRunFasterThanTheClock) {
  Idle idle;
  EXPECT_THROW(PacedFcu(idle, 1.5), std::invalid_argument);
  EXPECT_THROW(PacedFcu(idle, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace ironbird::hil_bridge
