#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::scenarios {

/// Times that another process of ours measures and this one reads.
class SharedTimes {
 public:
  /// @throws std::runtime_error without memory
  explicit SharedTimes(std::size_t room);
  ~SharedTimes();
  SharedTimes(const SharedTimes&) = delete;
  SharedTimes& operator=(const SharedTimes&) = delete;

  /// What does not fit is dropped.
  void add(hil_bridge::Time time);
  std::vector<hil_bridge::Time> all() const;

 private:
  struct Memory;
  Memory* memory_;
  std::size_t room_;
};

/// Another process of ours that works until this goes out of scope, and never outlives us.
class SideProcess {
 public:
  /// Call it before any thread exists. @param work  may end by itself; what it throws is lost
  explicit SideProcess(const std::function<void()>& work);
  ~SideProcess();
  SideProcess(const SideProcess&) = delete;
  SideProcess& operator=(const SideProcess&) = delete;

 private:
  pid_t process_ = -1;
};

/// Room for an hour of measure_jitter(), and more.
inline constexpr std::size_t kHourOfWakings = 4'000'000;

/// Sleeps a millisecond at a time and notes by how much it is late each time, for ever.
void measure_jitter(SharedTimes& times);

}  // namespace ironbird::scenarios
