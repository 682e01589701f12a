#include "hil_bridge/executive/real_time_rights.hpp"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace ironbird::hil_bridge {

namespace {

// Above ordinary threads, below the kernel's own interrupt threads at 50.
constexpr int kPriority = 40;

}  // namespace

std::string take_real_time_rights() {
  // Memory once taken from the machine is kept: giving it back and taking it again would cost page faults.
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  sched_param priority{};
  priority.sched_priority = kPriority;
  const bool first = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
  if (locked && first) return "";
  const std::string what = locked  ? "real-time priority"
                           : first ? "locked memory"
                                   : "real-time priority and locked memory";
  return "no right to " + what +
         ": a busy machine may delay commands; allow it with limits rtprio and memlock in "
         "/etc/security/limits.d";
}

void unlock_memory() {
  munlockall();
}

}  // namespace ironbird::hil_bridge
