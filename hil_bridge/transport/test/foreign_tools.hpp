#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

// Tools that others wrote, as peers on the bus.

namespace ironbird::hil_bridge::transport {

/// Long enough for an emulated machine on a busy host.
inline constexpr std::chrono::seconds kPatience{30};

/// Looks again and again. @return whether it came true in time
inline bool comes_true(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// Runs a command line to its end. @throws std::runtime_error when it fails
inline void run(const std::string& command) {
  const int status = std::system(("PATH=$PATH:/usr/sbin:/sbin; " + command).c_str());
  if (status != 0) throw std::runtime_error("failed: " + command);
}

/// Sockets that listen to everything on an interface.
inline int listeners(const std::string& interface) {
  std::ifstream list("/proc/net/can/rcvlist_all");
  int count = 0;
  for (std::string word; list >> word;) count += word == interface ? 1 : 0;
  return count;
}

/// A tool that runs beside the test and whose output is read when it has ended.
class Tool {
 public:
  explicit Tool(const std::string& command) {
    pipe_ = popen(("exec " + command).c_str(), "r");
    if (pipe_ == nullptr) throw std::runtime_error("cannot start: " + command);
  }
  ~Tool() {
    if (pipe_ != nullptr) pclose(pipe_);
  }
  Tool(const Tool&) = delete;
  Tool& operator=(const Tool&) = delete;

  /// Waits for its end.
  std::vector<std::string> lines() {
    std::vector<std::string> all;
    char line[512];
    while (std::fgets(line, sizeof line, pipe_) != nullptr) {
      all.emplace_back(line);
      all.back().erase(all.back().find_last_not_of("\r\n") + 1);
    }
    pclose(pipe_);
    pipe_ = nullptr;
    return all;
  }

 private:
  FILE* pipe_ = nullptr;
};

/// candump that ends after so many frames, or when it has heard nothing for a while. Listens already when it
/// is built.
class Candump {
 public:
  Candump(const std::string& interface, int frames)
      : before_(listeners(interface)), tool_(line(interface, frames)) {
    if (!comes_true([&] { return listeners(interface) > before_; }))
      throw std::runtime_error("candump does not listen");
  }

  /// The frames as they are written in a log, without time and interface.
  std::vector<std::string> frames() {
    std::vector<std::string> all;
    for (const std::string& line : tool_.lines()) all.push_back(line.substr(line.rfind(' ') + 1));
    return all;
  }

 private:
  static std::string line(const std::string& interface, int frames) {
    const std::string silence = std::to_string(std::chrono::milliseconds(kPatience).count());
    // Room for more frames than a test sends in one go: a tool that is not scheduled in time must not lose
    // any.
    return "candump -L -r 1000000 -T " + silence + " -n " + std::to_string(frames) + ' ' + interface;
  }

  int before_;
  Tool tool_;
};

}  // namespace ironbird::hil_bridge::transport
