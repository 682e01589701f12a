// The program seen from outside: one process is a unit, others talk to it.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hil_bridge/transport/pseudo_terminal.hpp"
#include "scenarios/fcu/test/fcu_program.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {
namespace {

using hil_bridge::transport::PseudoTerminal;
using test::FcuProgramTest;
using test::kMission;
using test::Outcome;
using test::run;
using test::Running;
using test::Server;
using testing::ContainsRegex;
using testing::HasSubstr;

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

TEST_F(FcuProgramTest, SaysWhetherAnythingSpeaksWhereThereIsNoUnit) {
  PseudoTerminal port(link_);
  const std::string words = "fcu info --patience 1 --port " + link_;
  EXPECT_EQ(run(words).text,
            link_ + " at 921600 Bd: nothing is heard; is the unit powered, and is this its port?\n");
  const std::jthread receiver([&port](const std::stop_token& stop) {
    const std::string_view fix = "$GPGLL,4717.11,N,00833.91,E,092321.00,A,A*60\r\n";
    while (!stop.stop_requested()) {
      port.write(std::vector<std::uint8_t>(fix.begin(), fix.end()));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  EXPECT_THAT(run(words).text,
              HasSubstr("bytes come, but no frame of ROSflight 2.0; is the baud rate right"));
}

TEST_F(FcuProgramTest, ServesOnPortsThatAreNotTheUsualOnes) {
  const int port = 23000 + 2 * (getpid() % 5000);
  const std::string own = std::to_string(port), there = std::to_string(port + 1);
  const std::string serve = "fcu serve " + kMission + " --idle-pilot --duration 8 --udp " + own;
  Running server(serve + " --udp-to localhost:" + there);
  EXPECT_TRUE(server.says("connect with: ironbird fcu info --udp localhost:" + own + ":" + there));
  EXPECT_THAT(run("fcu info --patience 15 --udp localhost:" + own + ":" + there).text,
              HasSubstr("333 of 333"));
  EXPECT_EQ(run(serve + " --udp-to localhost:1:2").code, 2);
  EXPECT_EQ(run("fcu serve " + kMission + " --pty " + link_ + " --udp-to localhost").code, 2);
  server.end();
}

TEST_F(FcuProgramTest, SaysThatAUnitHasFallenSilent) {
  const Server server(link_, "pilot.arm_at=\"1000 s\"", "link.incoming.drop=1");
  Running asks("fcu info --patience 6 --port " + link_);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  kill(server.process(), SIGSTOP);
  EXPECT_THAT(asks.end().text, HasSubstr("it was heard, and is silent now"));
  kill(server.process(), SIGCONT);
}

TEST_F(FcuProgramTest, SavesComparesSetsAndLoadsParameters) {
  const Server server(link_);
  // Calibrations that end in between change parameters, too.
  for (const char* const bias : {"ACC_X_BIAS", "BARO_BIAS"}) {
    for (int k = 0; k < 20 && run(fcu(std::string("params get ") + bias)).text.ends_with(" 0\n"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
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

TEST_F(FcuProgramTest, SetsNoValueOutsideTheFirmwaresTable) {
  const Server server(link_);
  const std::string file = (folder_ / "wild.yaml").string();
  std::ofstream(file) << "- {name: RC_MAX_THR, type: 9, value: 0.5}\n"
                         "- {name: FAILSAFE_THR, type: 9, value: 7.5}\n"
                         "- {name: MOTOR_IDLE_THR, type: 9, value: .nan}\n";
  Outcome outcome = run(fcu("params load " + file));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text, file + ":2:40: FAILSAFE_THR = 7.5, must be between 0 and 1\n" + file +
                              ":3:42: MOTOR_IDLE_THR = .nan, must be finite\n");
  outcome = run(fcu("params set RC_MAX_THR 0.5 NUM_MOTORS 99999 PID_ROLL_RATE_P inf"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text,
            "NUM_MOTORS = 99999, must be between 1 and 10\nPID_ROLL_RATE_P = inf, must be finite\n");
  outcome = run(fcu("params set RC_MAX_THR 0.5 RC_MAX_THR 0.6"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text, "RC_MAX_THR: comes twice\n");
  EXPECT_THAT(run(fcu("params get RC_MAX_THR")).text, testing::Not(HasSubstr(" 0.5\n")));
  // What a unit has may be looked at, whatever it is.
  EXPECT_THAT(run(fcu("params verify " + file)).text, HasSubstr("3 differences"));
}

TEST_F(FcuProgramTest, SetsNothingInAnArmedUnit) {
  const Server server(link_, "pilot.arm_at=\"0 s\"");
  ASSERT_NO_FATAL_FAILURE(wait_until_armed());
  const Outcome outcome = run(fcu("params set RC_MAX_THR 0.5"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("the unit does not report that it is disarmed; nothing was set"));
  EXPECT_THAT(run(fcu("params get RC_MAX_THR")).text, testing::Not(HasSubstr(" 0.5\n")));
}

/// Every element of both mixers, with values that they do not have.
std::string written_mixers(const std::filesystem::path& file) {
  std::ofstream text(file);
  for (const char* const stem : {"SEC_MIXER_", "PRI_MIXER_"}) {
    for (int k = 0; k < 100; ++k) {
      text << "- {name: " << stem << k / 10 << "_" << k % 10 << ", type: 9, value: 0.12" << k << "}\n";
    }
  }
  return file.string();
}

// So few orders arrive that two hundred take a quarter of a minute.
constexpr const char* kSlowLine = "link.incoming.drop=0.7";

TEST_F(FcuProgramTest, SaysWhatIsSetWhenAUnitStopsInTheMiddle) {
  const Server server(link_, "pilot.arm_at=\"1000 s\"", kSlowLine);
  Running load(fcu("params load " + written_mixers(folder_ / "mixers.yaml")));
  EXPECT_TRUE(load.says("of 200 parameters are as wanted\n"));
  const auto stopped = std::chrono::steady_clock::now();
  kill(server.process(), SIGSTOP);
  const Outcome outcome = load.end();
  kill(server.process(), SIGCONT);
  EXPECT_LT(std::chrono::steady_clock::now() - stopped, std::chrono::seconds(15));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("; the unit is silent, waiting for it\n"));
  EXPECT_THAT(
      outcome.text,
      ContainsRegex("\nthe unit has fallen silent: [0-9]+ of 200 parameters are set, [0-9]+ are not"));
  EXPECT_THAT(outcome.text, HasSubstr("\nPRI_MIXER_9_9    wanted 0.1299, the unit last said "));
}

TEST_F(FcuProgramTest, SaysWhatIsSetWhenAUnitIsArmedInTheMiddle) {
  const Server server(link_, "pilot.arm_at=\"10 s\"", kSlowLine);
  const Outcome outcome = run(fcu("params load " + written_mixers(folder_ / "mixers.yaml")));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text,
              ContainsRegex("\nthe unit was armed: [0-9]+ of 200 parameters are set, [0-9]+ are not"));
  EXPECT_THAT(outcome.text, HasSubstr("\nPRI_MIXER_9_9    wanted 0.1299, the unit last said "));
}

TEST_F(FcuProgramTest, FollowsAUnitToAnotherSystemNumber) {
  const Server server(link_);
  Outcome outcome = run(fcu("params set SYS_ID 2"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("as wanted, read back from the unit: 1 parameter"));
  EXPECT_EQ(run(fcu("info")).code, 0);
  outcome = run(fcu("params set SYS_ID 1 RC_MAX_THR 0.5"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(run(fcu("params get SYS_ID")).text, HasSubstr(" 1\n"));
}

TEST_F(FcuProgramTest, TakesNobodysLinkAway) {
  const Server server(link_);
  const Outcome outcome = run("fcu serve " + kMission + " --pty " + link_ + " --duration 0.1");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, testing::StartsWith(link_ + ": is a link to /dev/pts/"));
  EXPECT_THAT(outcome.text,
              HasSubstr(", which process " + std::to_string(server.process()) + " (ironbird) has; end that"));
  EXPECT_EQ(run(fcu("info")).code, 0);
}

TEST_F(FcuProgramTest, TellsARefusalToKeepFromNoAnswer) {
  using hil_bridge::ParameterOutcome;
  EXPECT_THAT(why_not_kept(ParameterOutcome::kRefused),
              HasSubstr("the unit refused to write them to its flash"));
  EXPECT_THAT(why_not_kept(ParameterOutcome::kNoAnswer), HasSubstr("the unit did not confirm"));
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

TEST_F(FcuProgramTest, SaysInOneLineWhatIsWrongWithACanInterface) {
  const std::string scenario =
      std::string(IRONBIRD_SOURCE_DIR) + "/scenarios/library/paper/three_waypoints.toml";
  const Outcome outcome =
      run("fcu serve " + scenario + " --pty " + link_ + " --can nocan0 --on-desk --duration 1");
  EXPECT_EQ(outcome.code, 3);
  // A kernel without CAN says something else than one with it.
  EXPECT_THAT(outcome.text,
              testing::AllOf(HasSubstr("CAN interface nocan0: "),
                             testing::AnyOf(HasSubstr("modprobe can_raw"), HasSubstr("not found"))));
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1);
}

}  // namespace
}  // namespace ironbird::scenarios
