#include "hil_bridge/executive/paced_fcu.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "hil_bridge/transport/machine_clock.hpp"

namespace ironbird::hil_bridge {

using transport::machine_time;

PacedFcu::PacedFcu(Fcu& fcu, double time_scale) : fcu_(fcu), time_scale_(time_scale) {
  if (time_scale >= 0.001 && time_scale <= 1.0) return;
  throw std::invalid_argument("time_scale = " + std::to_string(time_scale) + ", must be between 0.001 and 1");
}

void PacedFcu::sleep_until(Time now) {
  const Time run(std::llround(static_cast<double>(now.count()) / time_scale_));
  if (zero_ == Time::min()) zero_ = machine_time() - run;
  transport::sleep_until(zero_ + run);
  // Who is stopped is mostly stopped while it sleeps.
  const Time behind = machine_time() - (zero_ + run);
  if (behind <= kGivenUp) return;
  zero_ += behind;
  lost_ += behind;
  unseen_ += Time(std::llround(static_cast<double>(behind.count()) * time_scale_));
}

Time PacedFcu::wait(Time now) {
  sleep_until(now);
  return std::exchange(unseen_, Time::zero());
}

void PacedFcu::advance(Time now) {
  sleep_until(now);
  fcu_.advance(now);
}

}  // namespace ironbird::hil_bridge
