#pragma once

#include <functional>
#include <map>
#include <optional>

namespace ironbird::scenarios {

/// How often each system call was made, by number.
using SystemCalls = std::map<long, int>;

/// Runs `work` in a child process and counts the system calls that it makes between two calls of the `mark`
/// it is given.
/// @return nothing when this machine does not let a process watch its child, or when the child did not finish
std::optional<SystemCalls> system_calls_between_marks(
    const std::function<void(const std::function<void()>& mark)>& work);

}  // namespace ironbird::scenarios
