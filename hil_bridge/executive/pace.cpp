#include "hil_bridge/executive/pace.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "hil_bridge/transport/machine_clock.hpp"

namespace ironbird::hil_bridge {

using transport::machine_time;

Pace::Pace(double time_scale) : time_scale_(time_scale) {
  if (time_scale >= 0.001 && time_scale <= 1.0) return;
  throw std::invalid_argument("time_scale = " + std::to_string(time_scale) + ", must be between 0.001 and 1");
}

Time Pace::wait(Time now) {
  const Time run(std::llround(static_cast<double>(now.count()) / time_scale_));
  if (zero_ == Time::min()) zero_ = machine_time() - run;
  transport::sleep_until(zero_ + run);
  // Who is stopped is mostly stopped while it sleeps.
  const Time behind = machine_time() - (zero_ + run);
  if (behind <= kGivenUp) return Time::zero();
  zero_ += behind;
  lost_ += behind;
  return Time(std::llround(static_cast<double>(behind.count()) * time_scale_));
}

}  // namespace ironbird::hil_bridge
