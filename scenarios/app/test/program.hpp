#pragma once

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "scenarios/app/test/temporary_folder.hpp"

namespace ironbird::scenarios {

/// A scenario that only a signal ends.
inline constexpr const char* kEndless = "duration = \"20 h\"\n[[waypoint]]\np_N = [0, 0, -5]\n";

/// What a command left behind: exit code and everything that it said.
struct Said {
  int exit_code = -1;
  std::string text;

  long lines() const { return std::count(text.begin(), text.end(), '\n'); }
};

/// Runs a command of the shell from the root of the tree, standard error included.
inline Said run_shell(const std::string& command) {
  const std::string whole = "cd '" IRONBIRD_SOURCE_DIR "' && export CI=true && { " + command + "; } 2>&1";
  FILE* pipe = popen(whole.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start a shell");
  Said said;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    said.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  said.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return said;
}

/// Runs a command of the shell on a terminal of its own, `columns` wide. What it says has the line ends and
/// the control codes of a terminal.
inline Said run_on_terminal(const std::string& command, unsigned short columns) {
  winsize size{};
  size.ws_col = columns;
  size.ws_row = 24;
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, &size);
  if (process < 0) throw std::runtime_error("cannot make a terminal");
  if (process == 0) {
    const std::string whole = "cd '" IRONBIRD_SOURCE_DIR "' && unset CI; export TERM=xterm; " + command;
    execl("/bin/sh", "sh", "-c", whole.c_str(), nullptr);
    _exit(127);
  }
  Said said;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(terminal, buffer.data(), buffer.size())) > 0;)
    said.text.append(buffer.data(), static_cast<std::size_t>(n));
  int status = 0;
  waitpid(process, &status, 0);
  close(terminal);
  said.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return said;
}

inline const std::string kProgram = "'" IRONBIRD_PROGRAM "'";

}  // namespace ironbird::scenarios
