#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "scenarios/app/run_listener.hpp"

namespace ironbird::scenarios {

/// How to speak to whoever reads what is said: a person at a terminal, or a log file.
struct Terminal {
  bool interactive = false;  ///< a terminal, and not CI: lines may be redrawn
  bool colour = false;       ///< NO_COLOR is not set
  std::size_t columns = 0;   ///< characters in a line; 0 when nobody knows
  std::size_t rows = 0;      ///< lines; 0 when nobody knows

  /// Asks the environment: isatty, CI, NO_COLOR, TERM, and the terminal for its size.
  static Terminal of_standard_error();
  static Terminal of_standard_output();
};

/// Shows how far a piece of work has come and how long the rest will take. On a terminal one line is redrawn
/// ten times a second and never wraps; elsewhere a plain line is written every half minute, so that a build
/// server sees that the program lives.
class ProgressBar {
 public:
  explicit ProgressBar(const Terminal& terminal);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const WorkDone& work);

  /// Removes the bar, for other words to be said.
  void clear();

 private:
  void draw(const WorkDone& work);

  Terminal terminal_;
  std::string label_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  bool visible_ = false;
};

/// The progress line in at most `columns` characters (0: as long as it likes): the bar goes first, then the
/// detail, then the end of the label.
std::string progress_line(const WorkDone& work, double seconds_left, std::size_t columns);

/// Tells a run to the terminal while it goes on.
class TerminalListener final : public RunListener {
 public:
  explicit TerminalListener(const Terminal& terminal) : terminal_(terminal), bar_(terminal) {}

  void progress(const WorkDone& work) override { bar_.show(work); }
  void judged(const Verdict& verdict) override;
  void note(const std::string& line) override;

 private:
  Terminal terminal_;
  ProgressBar bar_;
};

}  // namespace ironbird::scenarios
