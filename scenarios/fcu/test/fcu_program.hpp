#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

// The program seen from outside: one process is a unit, others talk to it.

namespace ironbird::scenarios::test {

namespace fs = std::filesystem;

inline const std::string kMission = IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml";

struct Outcome {
  int code = -1;
  std::string text;  // both streams
};

inline Outcome run(const std::string& words) {
  Outcome outcome;
  FILE* const pipe = popen((std::string(IRONBIRD_PROGRAM) + " " + words + " 2>&1").c_str(), "r");
  std::array<char, 4096> part{};
  while (const std::size_t count = fread(part.data(), 1, part.size(), pipe))
    outcome.text.append(part.data(), count);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// The program on its way: its words are heard as they come.
class Running {
 public:
  explicit Running(const std::string& words)
      : pipe_(popen((std::string(IRONBIRD_PROGRAM) + " " + words + " 2>&1").c_str(), "r")) {}

  /// Waits until it has said this. @return has it, before its end?
  bool says(const std::string& words) {
    while (outcome_.text.find(words) == std::string::npos) {
      if (!listen()) return false;
    }
    return true;
  }
  /// Waits for its end.
  Outcome end() {
    while (listen()) {
    }
    const int status = pclose(pipe_);
    outcome_.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome_;
  }

 private:
  bool listen() {
    std::array<char, 4096> part{};
    const ssize_t count = read(fileno(pipe_), part.data(), part.size());
    if (count > 0) outcome_.text.append(part.data(), static_cast<std::size_t>(count));
    return count > 0;
  }

  FILE* pipe_;
  Outcome outcome_;
};

/// Has a child come to its end? It is still there to be waited for.
inline bool has_ended(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
}

/// A unit served by another process for as long as this lives.
class Server {
 public:
  explicit Server(const std::string& link, const char* arm_at = "pilot.arm_at=\"1000 s\"",
                  const char* setting = "seed=7")
      : link_(link) {
    process_ = fork();
    if (process_ == 0) {
      (void)!freopen("/dev/null", "w", stderr);
      execl(IRONBIRD_PROGRAM, "ironbird", "fcu", "serve", kMission.c_str(), "--pty", link.c_str(), "--set",
            arm_at, "--set", setting, "--set", "pilot.take_off_at=\"1001 s\"", "--set", "duration=\"2000 s\"",
            nullptr);
      _exit(127);
    }
    for (int k = 0; k < 5000 && !fs::exists(link); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ~Server() {
    kill(process_, SIGINT);
    int status = 0;
    waitpid(process_, &status, 0);
  }
  pid_t process() const { return process_; }

 private:
  std::string link_;
  pid_t process_ = -1;
};

class FcuProgramTest : public testing::Test {
 protected:
  FcuProgramTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  std::string fcu(const std::string& words) const {
    return "fcu " + words + " --port " + link_ + " --patience 30";
  }
  /// A unit whose pilot arms as soon as somebody is there. A fatal failure when it does not.
  void wait_until_armed() const {
    bool armed = false;
    for (int k = 0; k < 10 && !armed; ++k) {
      const Outcome seen = run(fcu("info --json"));
      ASSERT_EQ(seen.code, 0) << seen.text;
      armed = nlohmann::json::parse(seen.text)["armed"];
    }
    ASSERT_TRUE(armed);
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("ironbird_fcu_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string link_ = (folder_ / "unit").string();
};

}  // namespace ironbird::scenarios::test
