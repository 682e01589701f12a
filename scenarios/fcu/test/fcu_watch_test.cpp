// Watching, judging and calibrating a unit, seen from outside.

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "scenarios/app/test/program.hpp"
#include "scenarios/fcu/test/fcu_program.hpp"

namespace ironbird::scenarios {
namespace {

using test::FcuProgramTest;
using test::kMission;
using test::Outcome;
using test::run;
using test::Server;
using testing::HasSubstr;
using testing::Not;

TEST_F(FcuProgramTest, WatchesAUnitALineASecondWhereNobodyCanRedraw) {
  const Server server(link_);
  const Outcome outcome = run(fcu("monitor --seconds 2.5"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 3);
  EXPECT_THAT(outcome.text, HasSubstr("disarmed  errors: "));
  EXPECT_THAT(outcome.text, HasSubstr("outputs 0.00 0.00 0.00 0.00"));
  EXPECT_THAT(outcome.text, Not(HasSubstr("\033")));
}

TEST_F(FcuProgramTest, WatchesAUnitForProgramsToo) {
  const Server server(link_);
  const Outcome outcome = run(fcu("monitor --seconds 2 --json"));
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  std::istringstream lines(outcome.text);
  nlohmann::json last;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) last = nlohmann::json::parse(line);
  EXPECT_EQ(count, 2);
  EXPECT_EQ(last["status"]["armed"], 0);
  EXPECT_EQ(last["link"]["silent"], false);
  EXPECT_EQ(last["link"]["corrupted"], 0);
  EXPECT_NEAR(last["imu"]["zacc"].get<double>(), -9.81, 0.3);
  EXPECT_EQ(last["output_raw"]["values"].size(), 14U);
  EXPECT_EQ(last["rc"]["chan1_raw"], 1500);
}

TEST_F(FcuProgramTest, RedrawsItsViewInPlaceOnATerminal) {
  const Server server(link_);
  const std::string words = kProgram + " " + fcu("monitor --seconds 1.5");
  const Said coloured = run_on_terminal(words, 100);
  EXPECT_EQ(coloured.exit_code, 0) << coloured.text;
  EXPECT_THAT(coloured.text, HasSubstr("\033["));
  EXPECT_THAT(coloured.text, HasSubstr("A\r"));  // up again
  for (const char* name :
       {"attitude", "rates", "IMU", "compass", "barometer", "satellites", "outputs", "battery", "radio"}) {
    EXPECT_THAT(coloured.text, HasSubstr(name));
  }
  const Said plain = run_on_terminal("NO_COLOR=1 " + words, 100);
  EXPECT_THAT(plain.text, Not(HasSubstr("\033[31m")));
}

TEST_F(FcuProgramTest, SaysThatAUnitIsSilent) {
  Outcome outcome;
  {
    const Server server(link_);
    EXPECT_EQ(run(fcu("monitor --seconds 1")).code, 0);
    kill(server.process(), SIGSTOP);
    outcome = run(fcu("monitor --seconds 1.2"));
    kill(server.process(), SIGCONT);
  }
  EXPECT_EQ(outcome.code, 3) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("SILENT for 1."));
}

TEST_F(FcuProgramTest, FindsAUnitReadyOrSaysWhatSpeaksAgainstIt) {
  const Server server(link_);
  Outcome outcome = run(fcu("params load " + kMission));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  // A busy machine may lose frames, or time, and be told so; not three times in a row.
  for (int k = 0; k < 3 && (k == 0 || outcome.code != 0); ++k) outcome = run(fcu("preflight " + kMission));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("\nready\n"));
  ASSERT_EQ(run(fcu("params set RC_MAX_THR 0.5 FAILSAFE_THR 0.25")).code, 0);
  outcome = run(fcu("preflight --json " + kMission));
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  const nlohmann::json json = nlohmann::json::parse(outcome.text);
  EXPECT_EQ(json["ready"], false);
  for (const auto& item : json["items"]) {
    if (item["name"] != "parameters") continue;
    EXPECT_EQ(item["light"], "red");
    EXPECT_THAT(item["reason"], HasSubstr("FAILSAFE_THR is 0.25, wanted"));
    EXPECT_THAT(item["reason"], HasSubstr("ironbird fcu params load " + kMission));
  }
}

TEST_F(FcuProgramTest, EndsAPreflightWithoutALinkWithThree) {
  const Outcome outcome = run("fcu preflight --port /dev/no_such_port");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("/dev/no_such_port: there is no such port"));
}

TEST_F(FcuProgramTest, CalibratesTheImuAndTellsTheResult) {
  const Server server(link_);
  Outcome outcome = run(fcu("calibrate imu --keep"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("imu: calibrated"));
  EXPECT_THAT(outcome.text, HasSubstr("ACC_Z_BIAS       was "));
  outcome = run(fcu("calibrate compass"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("there are: rc-trim, imu, gyro, baro, airspeed"));
}

TEST_F(FcuProgramTest, CalibratesNothingInAnArmedUnit) {
  const Server server(link_, "pilot.arm_at=\"0 s\"");
  ASSERT_NO_FATAL_FAILURE(wait_until_armed());
  const Outcome outcome = run(fcu("calibrate gyro"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.text, HasSubstr("does not report that it is disarmed; nothing was ordered"));
  EXPECT_EQ(run(fcu("preflight")).code, 1);
}

TEST_F(FcuProgramTest, MeasuresTheRoundTripToAUnitOfItsOwn) {
  const Outcome outcome = run("fcu monitor --latency --seconds 2 --json --self " + kMission);
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const nlohmann::json json = nlohmann::json::parse(outcome.text);
  for (const char* what : {"round_trip", "turn_around", "jitter"}) {
    EXPECT_GT(json[what]["count"].get<int>(), 50) << what;
    EXPECT_LE(json[what]["p50_us"].get<double>(), json[what]["p99_us"].get<double>()) << what;
    EXPECT_LE(json[what]["p99_us"].get<double>(), json[what]["greatest_us"].get<double>()) << what;
    EXPECT_GT(json[what]["p50_us"].get<double>(), 0.0) << what;
  }
  EXPECT_GE(json["round_trip"]["p50_us"].get<double>(), json["turn_around"]["p50_us"].get<double>());
  EXPECT_EQ(run("fcu monitor --self " + kMission + " --port /dev/null").code, 2);
}

TEST_F(FcuProgramTest, MeasuresTheRoundTripOverALine) {
  const Server server(link_);
  const Outcome outcome = run(fcu("monitor --latency --seconds 2"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("question for the unit's clock to its answer"));
}

}  // namespace
}  // namespace ironbird::scenarios
