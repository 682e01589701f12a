#pragma once

#include <chrono>

namespace ironbird::simulator {

/// Time since the start of the run. An integer, so that periods are exact and a run can be repeated to the
/// bit.
using Time = std::chrono::nanoseconds;

/// A difference of times as a number, s.
constexpr double seconds(Time difference) {
  return static_cast<double>(difference.count()) * 1e-9;
}

}  // namespace ironbird::simulator
