#include "scenarios/app/run_jobs.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/requirements/verdict_json.hpp"

namespace ironbird::scenarios {

namespace {

void report(const RunResult& result) {
  if (!result.error.empty()) std::fprintf(stderr, "%s\n", result.error.c_str());
}

/// What a finished child left behind.
RunResult collect(const RunJob& job, int status) {
  RunResult result{job.folder, std::nullopt, kExitInternal, {}};
  if (WIFEXITED(status)) {
    result.exit_code = WEXITSTATUS(status);
  } else {
    result.error = job.folder.string() + ": the run was ended by signal " + std::to_string(WTERMSIG(status));
    report(result);
  }
  if (result.exit_code == kExitPass || result.exit_code == kExitFail ||
      result.exit_code == kExitInconclusive) {
    result.verdict = read_verdict(job.folder / "verdict.json");
  }
  return result;
}

pid_t start_child(const RunJob& job, const autopilot::Modules& modules, Terminal terminal) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(errno));
  if (child > 0) return child;
  terminal.interactive = false;  // several bars on one line help nobody
  const RunResult result = run_job(job, modules, terminal);
  report(result);
  std::fflush(nullptr);
  _exit(result.exit_code);
}

std::vector<RunResult> run_in_children(const std::vector<RunJob>& jobs, const autopilot::Modules& modules,
                                       int at_once, const Terminal& terminal) {
  std::vector<RunResult> results(jobs.size());
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  while (next < jobs.size() || !running.empty()) {
    while (next < jobs.size() && running.size() < static_cast<std::size_t>(at_once) &&
           !interrupt_requested()) {
      running[start_child(jobs[next], modules, terminal)] = next;
      ++next;
    }
    if (running.empty()) break;
    int status = 0;
    const pid_t child = wait(&status);
    if (child < 0 && errno == EINTR) continue;
    const auto found = running.find(child);
    if (found == running.end()) continue;
    results[found->second] = collect(jobs[found->second], status);
    running.erase(found);
  }
  for (; next < jobs.size(); ++next)
    results[next] = {jobs[next].folder, std::nullopt, kExitInterrupted, "interrupted"};
  return results;
}

}  // namespace

std::vector<RunResult> run_jobs(const std::vector<RunJob>& jobs, const autopilot::Modules& modules,
                                int at_once, const Terminal& terminal) {
  note_interrupts();
  if (at_once > 1 && jobs.size() > 1) return run_in_children(jobs, modules, at_once, terminal);
  std::vector<RunResult> results;
  for (const RunJob& job : jobs) {
    if (interrupt_requested()) {
      results.push_back({job.folder, std::nullopt, kExitInterrupted, "interrupted"});
      continue;
    }
    results.push_back(run_job(job, modules, terminal));
    report(results.back());
  }
  return results;
}

}  // namespace ironbird::scenarios
