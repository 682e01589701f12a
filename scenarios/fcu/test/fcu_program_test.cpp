// The program seen from outside: one process is a unit, others talk to it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string text;  // both streams
};

Outcome run(const std::string& words) {
  Outcome outcome;
  FILE* const pipe = popen((std::string(IRONBIRD_PROGRAM) + " " + words + " 2>&1").c_str(), "r");
  std::array<char, 4096> part{};
  while (const std::size_t count = fread(part.data(), 1, part.size(), pipe))
    outcome.text.append(part.data(), count);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// A unit served by another process for as long as this lives.
class Server {
 public:
  explicit Server(const std::string& link, const char* arm_at = "pilot.arm_at=\"1000 s\"") : link_(link) {
    process_ = fork();
    if (process_ == 0) {
      const std::string scenario =
          std::string(IRONBIRD_SOURCE_DIR) + "/scenarios/library/paper/three_waypoints.toml";
      (void)!freopen("/dev/null", "w", stderr);
      execl(IRONBIRD_PROGRAM, "ironbird", "fcu", "serve", scenario.c_str(), "--pty", link.c_str(), "--set",
            arm_at, "--set", "pilot.take_off_at=\"1001 s\"", "--set", "duration=\"2000 s\"", nullptr);
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

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("ironbird_fcu_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string link_ = (folder_ / "unit").string();
};

TEST_F(FcuProgramTest, SaysWhatIsConnected) {
  const Server server(link_);
  const Outcome outcome = run(fcu("info --json"));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const nlohmann::json json = nlohmann::json::parse(outcome.text);
  EXPECT_EQ(json["firmware"], "v2.0.1-ironbird");
  EXPECT_EQ(json["parameters"], 333);
  EXPECT_EQ(json["armed"], false);
  EXPECT_EQ(json["loss"], 0.0);
  EXPECT_THAT(run(fcu("info")).text, HasSubstr("errors"));
}

TEST_F(FcuProgramTest, SavesComparesSetsAndLoadsParameters) {
  const Server server(link_);
  const std::string file = (folder_ / "before.yaml").string();
  ASSERT_EQ(run(fcu("params save " + file)).code, 0);
  EXPECT_EQ(run(fcu("params diff " + file)).code, 0);
  Outcome outcome = run(fcu("params set RC_MAX_THR 0.8125 RC_ARM_CHN -1 --keep"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(run(fcu("params get RC_MAX_THR")).text, HasSubstr("0.8125"));
  outcome = run(fcu("params verify " + file));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("RC_MAX_THR"));
  outcome = run(fcu("params load " + file));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(run(fcu("params diff " + file)).code, 0);
}

TEST_F(FcuProgramTest, SetsNothingOfAFileThatDoesNotFit) {
  const Server server(link_);
  const std::string file = (folder_ / "wrong.yaml").string();
  std::ofstream(file)
      << "- {name: RC_MAX_THR, type: 9, value: 0.5}\n- {name: RC_MAX_THRR, type: 9, value: 0.5}\n";
  const Outcome outcome = run(fcu("params load " + file));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text, "RC_MAX_THRR: the unit has no such parameter; did you mean RC_MAX_THR?\n");
  EXPECT_THAT(run(fcu("params get RC_MAX_THR")).text, testing::Not(HasSubstr("0.5\n")));
}

TEST_F(FcuProgramTest, SetsNothingInAnArmedUnit) {
  const Server server(link_, "pilot.arm_at=\"0 s\"");
  bool armed = false;
  for (int k = 0; k < 10 && !armed; ++k) {
    const Outcome seen = run(fcu("info --json"));
    ASSERT_EQ(seen.code, 0) << seen.text;
    armed = nlohmann::json::parse(seen.text)["armed"];
  }
  ASSERT_TRUE(armed);
  const Outcome outcome = run(fcu("params set RC_MAX_THR 0.5"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("the unit does not report that it is disarmed; nothing was set"));
  EXPECT_THAT(run(fcu("params get RC_MAX_THR")).text, testing::Not(HasSubstr(" 0.5\n")));
}

TEST_F(FcuProgramTest, SaysWhatIsWrongWithALine) {
  Outcome outcome = run("fcu info --port /dev/no_such_port");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("/dev/no_such_port: there is no such port"));
  outcome = run("fcu info");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("either --port DEVICE or --udp HOST[:PORT]"));
  outcome = run("fcu info --udp localhost:fast");
  EXPECT_EQ(outcome.code, 2);
  outcome = run("fcu params --port /dev/null bend X");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("there are: get, set, save, load, diff, verify"));
}

}  // namespace
}  // namespace ironbird::scenarios
