#include "hil_bridge/executive/paced_fcu.hpp"

#include <time.h>

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

namespace ironbird::hil_bridge {

namespace {

Time clock_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void sleep_until(Time when) {
  const timespec at{when.count() / 1'000'000'000, when.count() % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
}

}  // namespace

PacedFcu::PacedFcu(Fcu& fcu, double time_scale) : fcu_(fcu), time_scale_(time_scale) {
  if (time_scale >= 0.001 && time_scale <= 1.0) return;
  throw std::invalid_argument("time_scale = " + std::to_string(time_scale) + ", must be between 0.001 and 1");
}

void PacedFcu::advance(Time now) {
  const Time run(std::llround(static_cast<double>(now.count()) / time_scale_));
  if (zero_ == Time::min()) zero_ = clock_now() - run;
  const Time behind = clock_now() - (zero_ + run);
  if (behind > kGivenUp) {
    zero_ += behind;
    lost_ += behind;
  } else if (behind < Time::zero()) {
    sleep_until(zero_ + run);
  }
  fcu_.advance(now);
}

}  // namespace ironbird::hil_bridge
