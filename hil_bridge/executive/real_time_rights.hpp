#pragma once

#include <string>

namespace ironbird::hil_bridge {

/// Asks for what a control loop wants of the machine: this thread runs before all ordinary ones (SCHED_FIFO),
/// and the program's memory stays where it is. Never fails.
/// @return what was not granted and how to get it, one line; empty when all was
std::string take_real_time_rights();

/// The program's memory may move again.
void unlock_memory();

}  // namespace ironbird::hil_bridge
