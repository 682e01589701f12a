#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// One run in a process of its own, which tells over a pipe how it goes and how it ended. The process does
/// not outlive its parent, however the parent ends.
class ChildRun {
 public:
  /// Starts it. @throws UserError when the machine refuses
  ChildRun(const RunJob& job, const autopilot::Modules& modules);
  ~ChildRun();
  ChildRun(ChildRun&& other) noexcept;
  ChildRun& operator=(ChildRun&& other) noexcept;

  /// To be polled for input.
  int descriptor() const { return pipe_; }

  /// Takes in what has arrived. @return false when the run has ended
  bool listen();

  /// How much of the run is done, 0 to 1.
  double share() const { return share_; }

  /// What the run wanted to be said since the last call.
  std::vector<std::string> take_notes();

  /// Asks it to end, as Ctrl-C does.
  void interrupt() const;

  /// Ends it at once.
  void kill() const;

  /// Waits until the process has gone, and says what became of the run.
  RunResult result();

 private:
  void hear(const std::string& line);

  RunName name_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::string unread_;
  double share_ = 0.0;
  std::vector<std::string> notes_;
  std::optional<RunResult> told_;
};

}  // namespace ironbird::scenarios
