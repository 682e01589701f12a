#include "scenarios/fcu/side_process.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>

#include "hil_bridge/transport/machine_clock.hpp"

namespace ironbird::scenarios {

using hil_bridge::Time;
using hil_bridge::transport::machine_time;

struct SharedTimes::Memory {
  std::atomic<std::size_t> count{0};
  std::int64_t* times() { return reinterpret_cast<std::int64_t*>(this + 1); }
};

SharedTimes::SharedTimes(std::size_t room) : room_(room) {
  void* const memory = mmap(nullptr, sizeof(Memory) + room * sizeof(std::int64_t), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory to share with another process");
  memory_ = new (memory) Memory;
}

SharedTimes::~SharedTimes() {
  munmap(memory_, sizeof(Memory) + room_ * sizeof(std::int64_t));
}

void SharedTimes::add(Time time) {
  const std::size_t place = memory_->count.load(std::memory_order_relaxed);
  if (place == room_) return;
  memory_->times()[place] = time.count();
  memory_->count.store(place + 1, std::memory_order_release);
}

std::vector<Time> SharedTimes::all() const {
  const std::size_t count = memory_->count.load(std::memory_order_acquire);
  std::vector<Time> times(count);
  std::transform(memory_->times(), memory_->times() + count, times.begin(),
                 [](std::int64_t ns) { return Time{ns}; });
  return times;
}

SideProcess::SideProcess(const std::function<void()>& work) {
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("another process cannot be started");
  if (process_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    if (getppid() == parent) work();
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

SideProcess::~SideProcess() {
  kill(process_, SIGKILL);
  int status = 0;
  waitpid(process_, &status, 0);
}

void measure_jitter(SharedTimes& times) {
  constexpr Time kPeriod = std::chrono::milliseconds(1);
  for (Time next = machine_time() + kPeriod;; next = std::max(next, machine_time()) + kPeriod) {
    hil_bridge::transport::sleep_until(next);
    times.add(machine_time() - next);
  }
}

}  // namespace ironbird::scenarios
