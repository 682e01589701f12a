#include "hil_bridge/executive/page_faults.hpp"

#include <sys/resource.h>

namespace ironbird::hil_bridge {

std::uint64_t page_faults_of_this_thread() {
  rusage used{};
  getrusage(RUSAGE_THREAD, &used);
  return static_cast<std::uint64_t>(used.ru_minflt) + static_cast<std::uint64_t>(used.ru_majflt);
}

}  // namespace ironbird::hil_bridge
