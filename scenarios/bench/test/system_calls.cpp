#include "scenarios/bench/test/system_calls.hpp"

#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace ironbird::scenarios {

namespace {

/// A call that nothing else makes here.
constexpr long kMark = SYS_getppid;

[[noreturn]] void be_watched(const std::function<void(const std::function<void()>&)>& work) {
  if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(EXIT_FAILURE);
  raise(SIGSTOP);
  work([] { syscall(kMark); });
  _exit(EXIT_SUCCESS);
}

/// Lets the child run until it enters or leaves a system call. @return false when it has ended
bool go_on(pid_t child, int& status) {
  if (ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) != 0) return false;
  return waitpid(child, &status, 0) == child && WIFSTOPPED(status);
}

/// The number of the call that the child is entering.
std::optional<long> entered(pid_t child) {
  __ptrace_syscall_info info{};
  if (ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0) return {};
  if (info.op != PTRACE_SYSCALL_INFO_ENTRY) return {};
  return static_cast<long>(info.entry.nr);
}

}  // namespace

std::optional<SystemCalls> system_calls_between_marks(
    const std::function<void(const std::function<void()>& mark)>& work) {
  const pid_t child = fork();
  if (child == 0) be_watched(work);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) return {};
  // Tells stops at system calls from other ones.
  if (ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD) != 0) return {};
  SystemCalls calls;
  int marks = 0;
  while (go_on(child, status)) {
    const std::optional<long> call = entered(child);
    if (!call) continue;
    if (*call == kMark) {
      ++marks;
    } else if (marks == 1) {
      ++calls[*call];
    }
  }
  const bool finished = WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS && marks == 2;
  return finished ? std::optional(calls) : std::nullopt;
}

}  // namespace ironbird::scenarios
