#include "hil_bridge/executive/monotonic_clock.hpp"

#include <poll.h>
#include <time.h>

#include <algorithm>

namespace ironbird::hil_bridge {

namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

Time since_boot() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return Time{time.tv_sec * kNanoseconds + time.tv_nsec};
}

}  // namespace

MonotonicClock::MonotonicClock() : start_(since_boot()) {}

Time MonotonicClock::now() {
  return since_boot() - start_;
}

void MonotonicClock::wait(int descriptor, Time until) {
  const Time left = std::max(until - now(), Time::zero());
  const timespec patience{left.count() / kNanoseconds, left.count() % kNanoseconds};
  pollfd line{descriptor, POLLIN, 0};
  ppoll(&line, 1, &patience, nullptr);
}

}  // namespace ironbird::hil_bridge
