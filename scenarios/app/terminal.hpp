#pragma once

#include <chrono>
#include <string>

namespace ironbird::scenarios {

/// How to speak to whoever reads standard error: a person at a terminal, or a log file.
struct Terminal {
  bool interactive = false;  ///< a terminal, and not CI: lines may be redrawn
  bool colour = false;       ///< NO_COLOR is not set

  /// Asks the environment: isatty, CI, NO_COLOR, TERM.
  static Terminal of_standard_error();
};

/// Shows how far a run has come: simulated time, real-time factor, time left. On a terminal one line is
/// redrawn ten times a second; elsewhere nothing is written until the end.
class ProgressBar {
 public:
  ProgressBar(const Terminal& terminal, std::string label);
  ~ProgressBar();

  /// @param done, total  of the work, in any unit; `detail` is put behind the bar
  void show(double done, double total, const std::string& detail);

  /// Removes the bar.
  void clear();

 private:
  Terminal terminal_;
  std::string label_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  bool visible_ = false;
};

}  // namespace ironbird::scenarios
