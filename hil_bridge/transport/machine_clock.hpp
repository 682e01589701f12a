#pragma once

#include <time.h>

#include <cerrno>
#include <chrono>
#include <cstdint>

namespace ironbird::hil_bridge::transport {

/// The machine's clock that does not jump, since it was started.
inline std::chrono::nanoseconds machine_time() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// Sleeps until machine_time() is `when`, whatever signals come. The past is over at once.
inline void sleep_until(std::chrono::nanoseconds when) {
  constexpr std::int64_t kSecond = 1'000'000'000;  // ns
  const timespec at{when.count() / kSecond, when.count() % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

}  // namespace ironbird::hil_bridge::transport
