// A run on a unit, and the watchdog process beside it, seen from outside.

#include <csignal>
#include <fstream>
#include <sstream>
#include <string>

#include "scenarios/fcu/test/fcu_program.hpp"

namespace ironbird::scenarios {
namespace {

using test::FcuProgramTest;
using test::has_ended;
using test::kMission;
using test::Server;
using testing::HasSubstr;
using testing::Not;

/// `ironbird run` on the unit at this line, in another process, its words in a file.
class LiveRun {
 public:
  LiveRun(const std::string& line, const std::string& profile, const std::filesystem::path& folder)
      : words_(folder / "words") {
    const std::string out = (folder / "out").string();
    const std::string file = words_.string();
    const std::string reach = "fcu.line=\"" + line + "\"";
    const std::string kill_profile = "interlock.profile=\"" + profile + "\"";
    process_ = fork();
    if (process_ == 0) {
      (void)!freopen(file.c_str(), "w", stderr);
      execl(IRONBIRD_PROGRAM, "ironbird", "run", kMission.c_str(), "--set", "fcu.kind=\"serial\"", "--set",
            reach.c_str(), "--set", kill_profile.c_str(), "--release", "--patience", "30", "--no-report",
            "--out", out.c_str(), nullptr);
      _exit(127);
    }
  }
  ~LiveRun() {
    if (process_ > 0) end(SIGKILL);
  }

  std::string words() const {
    std::stringstream text;
    text << std::ifstream(words_).rdbuf();
    return text.str();
  }
  /// Waits no longer than the run lasts.
  bool says(const std::string& part, int seconds) const {
    for (int k = 0; k < 50 * seconds && words().find(part) == std::string::npos; ++k) {
      if (process_ > 0 && has_ended(process_)) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return words().find(part) != std::string::npos;
  }
  /// @return as waitpid says
  int end(int signal_number) {
    kill(process_, signal_number);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return status;
  }

 private:
  std::filesystem::path words_;
  pid_t process_ = -1;
};

constexpr const char* kArmsLate = "pilot.arm_at=\"10 s\"";
constexpr int kPatience = 60;  // s

TEST_F(FcuProgramTest, EndsALiveRunThatIsStoppedInSilenceInTheAir) {
  const Server server(link_, kArmsLate);
  LiveRun run(link_, "flight", folder_);
  ASSERT_TRUE(run.says("interlock live", kPatience)) << run.words();
  EXPECT_EQ(run.end(SIGSTOP), SIGKILL);
  EXPECT_TRUE(run.says("nothing more is sent", 5)) << run.words();
  EXPECT_THAT(run.words(), HasSubstr("watchdog: the control loop was silent for"));
  EXPECT_THAT(run.words(), HasSubstr("the bench was killed"));
}

TEST_F(FcuProgramTest, EndsALiveRunThatIsKilledInZerosOnTheBench) {
  const Server server(link_, kArmsLate);
  LiveRun run(link_, "bench", folder_);
  ASSERT_TRUE(run.says("interlock live", kPatience)) << run.words();
  EXPECT_EQ(run.end(SIGKILL), SIGKILL);
  EXPECT_TRUE(run.says("sending zero thrust", 5)) << run.words();
  EXPECT_THAT(run.words(), HasSubstr("watchdog: the bench has ended without taking leave"));
}

TEST_F(FcuProgramTest, TakesLeaveOfTheWatchdogWhenALiveRunIsInterrupted) {
  const Server server(link_, kArmsLate);
  LiveRun run(link_, "bench", folder_);
  ASSERT_TRUE(run.says("interlock released", kPatience)) << run.words();
  const int status = run.end(SIGINT);
  EXPECT_TRUE(WIFEXITED(status)) << status;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_THAT(run.words(), Not(HasSubstr("watchdog: ")));
}

}  // namespace
}  // namespace ironbird::scenarios
