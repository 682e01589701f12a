#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace ironbird::scenarios {

/// A number of seconds as a time of the run, to the nearest nanosecond.
inline std::chrono::nanoseconds from_seconds(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
}

/// A time of the run as a number, s.
inline double to_seconds(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) * 1e-9;
}

}  // namespace ironbird::scenarios
