#pragma once

#include <cstdint>

namespace ironbird::hil_bridge {

/// How often the calling thread has had to wait until the machine gave it memory, or read it from a disk,
/// since the thread began.
std::uint64_t page_faults_of_this_thread();

}  // namespace ironbird::hil_bridge
