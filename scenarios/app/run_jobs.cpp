#include "scenarios/app/run_jobs.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "scenarios/app/child_run.hpp"
#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"

namespace ironbird::scenarios {

namespace {

using Clock = std::chrono::steady_clock;

/// A run that has not ended this long after it was asked to is ended by force.
constexpr std::chrono::seconds kPatience{5};
constexpr int kPollMilliseconds = 100;

RunResult never_begun(const RunJob& job) {
  return {job.name, std::nullopt, kExitInterrupted, "interrupted before it began"};
}

/// Flies the jobs in processes of their own.
class Flock {
 public:
  Flock(const std::vector<RunJob>& jobs, const autopilot::Modules& modules, std::size_t at_once,
        const Terminal& terminal)
      : jobs_(jobs), modules_(modules), at_once_(at_once), bar_(terminal), results_(jobs.size()) {}

  std::vector<RunResult> fly() {
    while (true) {
      start_what_may();
      if (running_.empty()) break;
      wait();
      pass_interrupt_on();
      show();
    }
    for (; next_ < jobs_.size(); ++next_) results_[next_] = never_begun(jobs_[next_]);
    return std::move(results_);
  }

 private:
  void start_what_may() {
    for (; next_ < jobs_.size() && running_.size() < at_once_ && !interrupt_requested(); ++next_) {
      running_.emplace(next_, ChildRun(jobs_[next_], modules_));
    }
  }

  void wait() {
    std::vector<pollfd> watched;
    std::vector<std::size_t> who;
    for (const auto& [index, run] : running_) {
      watched.push_back({run.descriptor(), POLLIN, 0});
      who.push_back(index);
    }
    if (::poll(watched.data(), watched.size(), kPollMilliseconds) <= 0) return;
    for (std::size_t i = 0; i < watched.size(); ++i) {
      if (watched[i].revents != 0) listen_to(who[i]);
    }
  }

  void listen_to(std::size_t index) {
    ChildRun& run = running_.at(index);
    const bool goes_on = run.listen();
    for (const std::string& note : run.take_notes()) {
      bar_.clear();
      std::fprintf(stderr, "%s: %s\n", jobs_[index].name.text().c_str(), note.c_str());
    }
    if (goes_on) return;
    results_[index] = run.result();
    running_.erase(index);
    ++finished_;
    tell(results_[index]);
  }

  void pass_interrupt_on() {
    if (!interrupt_requested()) return;
    if (!asked_) {
      asked_ = Clock::now();
      for (const auto& [index, run] : running_) run.interrupt();
    } else if (Clock::now() - *asked_ > kPatience) {
      for (const auto& [index, run] : running_) run.kill();
    }
  }

  void show() {
    double done = static_cast<double>(finished_);
    for (const auto& [index, run] : running_) done += run.share();
    const std::string count = std::to_string(finished_) + " of " + std::to_string(jobs_.size()) + " done";
    bar_.show({"runs", done, static_cast<double>(jobs_.size()), count});
  }

  void tell(const RunResult& result) {
    bar_.clear();
    const std::string count = "[" + std::to_string(finished_) + "/" + std::to_string(jobs_.size()) + "] ";
    if (!result.verdict) {
      std::fputs(count.c_str(), stderr);
      return tell_error(result);
    }
    const Verdict& verdict = *result.verdict;
    std::string text = count + result.name.text() + ": " + std::string(name_of(verdict.outcome)) + "\n";
    for (const std::string& reason : reasons_of_the_run(verdict)) text += "  " + reason + "\n";
    for (const CheckResult& check : verdict.checks) {
      if (check.outcome == Outcome::kPass) continue;
      text +=
          "  " + std::string(name_of(check.outcome)) + ": " + check.name + ": " + check.explanation + "\n";
    }
    for (const std::string& warning : verdict.warnings) text += "  warning: " + warning + "\n";
    std::fputs(text.c_str(), stderr);
    tell_error(result);
  }

  const std::vector<RunJob>& jobs_;
  const autopilot::Modules& modules_;
  std::size_t at_once_;
  ProgressBar bar_;
  std::vector<RunResult> results_;
  std::map<std::size_t, ChildRun> running_;
  std::size_t next_ = 0;
  std::size_t finished_ = 0;
  std::optional<Clock::time_point> asked_;
};

}  // namespace

void tell_error(const RunResult& result) {
  std::istringstream lines(result.error);
  for (std::string line; std::getline(lines, line);) {
    // A finding in a file begins with the file; what else went wrong needs to say in which run.
    const bool placed = result.exit_code == kExitUsage && !result.verdict;
    std::fprintf(stderr, "%s%s\n", placed ? "" : (result.name.text() + ": ").c_str(), line.c_str());
  }
}

std::vector<RunResult> run_jobs(const std::vector<RunJob>& jobs, const autopilot::Modules& modules,
                                int at_once, const Terminal& terminal) {
  note_interrupts();
  if (at_once > 1 && jobs.size() > 1) {
    return Flock(jobs, modules, static_cast<std::size_t>(at_once), terminal).fly();
  }
  std::vector<RunResult> results;
  for (const RunJob& job : jobs) {
    if (interrupt_requested()) {
      results.push_back(never_begun(job));
      continue;
    }
    {
      TerminalListener listener(terminal);
      results.push_back(run_job(job, modules, listener));
    }
    tell_error(results.back());
  }
  return results;
}

}  // namespace ironbird::scenarios
