#pragma once

#include <exception>
#include <string>

namespace ironbird::scenarios {

/// An error as the program tells it.
struct Failure {
  int exit_code = 0;
  std::string text;  ///< what is wrong and what to do, a line for each finding, without a line end
};

/// Whoever runs the program can mend wrong usage, a wrong configuration and what their machine lacks: exit
/// code 2 and the error's own words. Everything else is a defect of the program, or of a module put into it:
/// exit code 4, and what to send to whom.
Failure failure_of(const std::exception& error);

/// What is to be said of a process that a signal has ended.
Failure failure_of_signal(int signal);

}  // namespace ironbird::scenarios
