// The program flies a unit that another process serves: in real time, over a pseudo-terminal. Times are
// asserted generously; exact ones are live_bench_test's, in a time of its own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/fcu/test/fcu_program.hpp"
#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;
using test::kMission;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// The program with these words, whose output goes to a file. Ends with this.
class Process {
 public:
  Process(const Words& words, fs::path output) : output_(std::move(output)) {
    process_ = fork();
    if (process_ != 0) return;
    (void)!freopen("/dev/null", "r", stdin);
    (void)!freopen(output_.c_str(), "w", stdout);
    dup2(STDOUT_FILENO, STDERR_FILENO);
    std::vector<char*> arguments = {const_cast<char*>("ironbird")};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(IRONBIRD_PROGRAM, arguments.data());
    _exit(127);
  }
  ~Process() {
    if (process_ > 0) {
      send(SIGKILL);
      wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { kill(process_, signal); }
  /// @return its exit code, -1 when a signal ended it
  int wait() {
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text() const {
    std::ifstream stream(output_);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  /// Waits no longer than the process lasts.
  bool says_within(const std::string& words, std::chrono::seconds patience) const {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (text().find(words) == std::string::npos) {
      if (std::chrono::steady_clock::now() > end || test::has_ended(process_))
        return text().find(words) != std::string::npos;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

 private:
  fs::path output_;
  pid_t process_ = -1;
};

class LiveProgramTest : public testing::Test {
 protected:
  LiveProgramTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  /// A unit whose pilot arms after so long, and more words.
  Process serve(const char* arm_at, const Words& more = {}) const {
    Words words = {"fcu", "serve", kMission, "--pty", link_, "--set", std::string("pilot.arm_at=") + arm_at};
    words.insert(words.end(), more.begin(), more.end());
    return Process(words, folder_ / "serve.txt");
  }
  void await_unit() const {
    for (int k = 0; k < 10000 && !fs::exists(link_); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  Words live(const Words& more) const {
    Words words = {"run",        kMission,
                   "--set",      "fcu.kind=serial",
                   "--set",      "fcu.line=" + link_,
                   "--out",      (folder_ / "out").string(),
                   "--no-report"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Process fly(const Words& more) const { return Process(live(more), folder_ / "run.txt"); }
  nlohmann::json verdict() const {
    std::ifstream stream(folder_ / "out/three_waypoints/verdict.json");
    return nlohmann::json::parse(stream, nullptr, false);
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) / ("ironbird_live_" + std::to_string(getpid()) + "_" +
                                      testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string link_ = (folder_ / "unit").string();
};

TEST_F(LiveProgramTest, DoesNothingWithoutAnOperatorsWord) {
  Process run = fly({});
  EXPECT_EQ(run.wait(), 2);
  EXPECT_THAT(run.text(), HasSubstr("fcu.kind = \"serial\" commands a real vehicle: say --release"));
}

TEST_F(LiveProgramTest, RefusesWhatOnlyASimulatorCanDo) {
  Process faults({"run", IRONBIRD_SOURCE_DIR "/scenarios/library/faults/rotor_loss.toml", "--set",
                  "fcu.kind=serial", "--set", "fcu.line=/dev/none", "--release"},
                 folder_ / "faults.txt");
  EXPECT_EQ(faults.wait(), 2);
  EXPECT_THAT(faults.text(), HasSubstr("fault: only a simulator can break things"));
  Process weather({"run", IRONBIRD_SOURCE_DIR "/scenarios/library/weather/steady_wind.toml", "--set",
                   "fcu.kind=serial", "--set", "fcu.line=/dev/none", "--release"},
                  folder_ / "weather.txt");
  EXPECT_EQ(weather.wait(), 2);
  EXPECT_THAT(weather.text(), HasSubstr("environment.wind: only a simulator makes weather"));
  Process nowhere({"run", kMission, "--set", "fcu.kind=serial", "--release"}, folder_ / "nowhere.txt");
  EXPECT_EQ(nowhere.wait(), 2);
  EXPECT_THAT(nowhere.text(), HasSubstr("fcu.line: must say where the unit is"));
}

TEST_F(LiveProgramTest, SaysWhatIsWrongWithALine) {
  Process run = fly({"--release"});
  EXPECT_EQ(run.wait(), 3);
  EXPECT_THAT(run.text(), HasSubstr("there is no such port"));
}

TEST_F(LiveProgramTest, RefusesAUnitWithOtherParameters) {
  const Process unit = serve("1000", {"--set", "fcu.parameters.FAILSAFE_THR=0.3"});
  await_unit();
  Process run = fly({"--release", "--patience", "60"});
  EXPECT_EQ(run.wait(), 3);
  EXPECT_THAT(run.text(), HasSubstr("FAILSAFE_THR is 0.3, must be 0.48"));
  EXPECT_THAT(run.text(), HasSubstr("set FAILSAFE_THR 0.48 --keep"));
}

TEST_F(LiveProgramTest, EndsWithCtrlCAndLeavesALogThatOpens) {
  const Process unit = serve("10");
  await_unit();
  Process run = fly({"--release", "--patience", "60"});
  // Before it is released: a machine that stands still ends a released run, rightly, in its own way.
  ASSERT_TRUE(run.says_within("interlock verified", std::chrono::seconds(60))) << run.text();
  run.send(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.text();
  const Log log = Log::read(folder_ / "out/three_waypoints/flight.mcap");
  EXPECT_FALSE(log.truncated());
  ASSERT_NE(log.topic("/autopilot/estimate"), nullptr);
  EXPECT_GT(log.topic("/autopilot/estimate")->time().size(), 50U);
  EXPECT_EQ(log.topic("/truth/state"), nullptr);
  ASSERT_NE(log.topic("/fcu/link"), nullptr);
  EXPECT_GT(log.topic("/fcu/link")->time().size(), 10U);
}

TEST_F(LiveProgramTest, IsEndedByItsWatchdogWhenItIsStopped) {
  const Process unit = serve("60");
  await_unit();
  Process run = fly({"--release", "--patience", "60"});
  ASSERT_TRUE(run.says_within("interlock released", std::chrono::seconds(60))) << run.text();
  run.send(SIGSTOP);
  EXPECT_EQ(run.wait(), -1) << "ended by a signal, not continued";
}

// Here no watchdog stands by: the simulation keeps the time.
TEST_F(LiveProgramTest, KillsAHilRunThatWasStoppedAndContinued) {
  const Process unit = serve("10", {"--on-desk"});
  await_unit();
  Process run(Words{"run", kMission, "--set", "fcu.kind=hil", "--set", "fcu.line=" + link_, "--set",
                    "duration=20 s", "--release", "--no-report", "--out", (folder_ / "out").string()},
              folder_ / "run.txt");
  std::this_thread::sleep_for(std::chrono::seconds(13));
  run.send(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(800));
  run.send(SIGCONT);
  EXPECT_EQ(run.wait(), 5) << run.text();
  std::string events;
  const nlohmann::json json = verdict();
  for (const auto& event : json["events"]) events += event["text"].get<std::string>() + "\n";
  EXPECT_THAT(events, HasSubstr("armed\n")) << run.text();
  EXPECT_THAT(events, HasSubstr("the control loop misses its period"));
}

/// Flies the paper's mission from take-off to landing and looks at how that went.
class LiveFlightTest : public LiveProgramTest {
 protected:
  /// A machine that stands still for this long cannot fly anything: the interlock kills, rightly, after 50
  /// ms.
  static constexpr double kStandsStill = 0.04;  // s
  static constexpr int kAttempts = 3;

  void fly_the_mission(const Words& unit_words) {
    for (int attempt = 1; attempt <= kAttempts; ++attempt) {
      const std::string text = fly_once(unit_words);
      const nlohmann::json json = verdict();
      ASSERT_TRUE(json.is_object()) << text;
      if (json["verdict"] == "invalid" && longest_pause(json) > kStandsStill) continue;
      return judge(json, text);
    }
    GTEST_SKIP() << "this machine stands still for longer than 40 ms at a time";
  }

 private:
  /// @return what the program said
  std::string fly_once(const Words& unit_words) {
    fs::remove(link_);
    const Process unit = serve("10", unit_words);
    await_unit();
    Process run = fly({"--release", "--patience", "60"});
    run.wait();
    return run.text();
  }

  /// How much too late the bench's control loop was woken at worst: not its own doing.
  static double longest_pause(const nlohmann::json& json) {
    for (const auto& stage : json["timing"]["stages"]) {
      if (stage["name"] == "jitter") return stage["greatest_s"];
    }
    return 0.0;
  }

  static void judge(const nlohmann::json& json, const std::string& text) {
    std::string events;
    for (const auto& event : json["events"]) events += event["text"].get<std::string>() + "\n";
    EXPECT_NE(json["verdict"], "invalid") << text;
    EXPECT_THAT(events, HasSubstr("live: the pilot armed"));
    EXPECT_THAT(events, HasSubstr("waypoint_7"));
    EXPECT_THAT(events, HasSubstr("landed"));
    EXPECT_LT(json["metrics"]["path_rms_total_m"], 0.05);
    EXPECT_LT(json["metrics"]["tracking_rms_total_m"], 0.35);
    EXPECT_GT(json["timing"]["passes"], 40'000);
    std::printf("path error %.4f m, tracking error %.4f m, missed %d of %d periods\n",
                json["metrics"]["path_rms_total_m"].get<double>(),
                json["metrics"]["tracking_rms_total_m"].get<double>(),
                json["timing"]["missed_periods"].get<int>(), json["timing"]["passes"].get<int>());
  }
};

TEST_F(LiveFlightTest, FliesAUnitInRealTime) {
  fly_the_mission({});
}

TEST_F(LiveFlightTest, FliesAUnitOnALineThatLosesAFifthOfEverythingBothWays) {
  fly_the_mission({"--set", "link.outgoing.drop=0.2", "--set", "link.incoming.drop=0.2"});
}

}  // namespace
}  // namespace ironbird::scenarios
