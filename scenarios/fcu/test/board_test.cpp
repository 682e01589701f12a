// With a real flight-control unit on the desk, propellers off: IRONBIRD_BOARD=/dev/serial/by-id/... names its
// port. Nothing here arms, commands a motor or changes the unit.

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/fcu/test/fcu_program.hpp"

namespace ironbird::scenarios {
namespace {

using test::Outcome;
using test::run;

class BoardTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* const port = std::getenv("IRONBIRD_BOARD");
    if (port == nullptr || *port == '\0') {
      GTEST_SKIP() << "needs a flight-control unit: name its port, IRONBIRD_BOARD=/dev/serial/by-id/...";
    }
    port_ = port;
  }
  Outcome fcu(const std::string& words) const {
    return run("fcu " + words + " --port " + port_ + " --patience 15");
  }

  std::string port_;
};

TEST_F(BoardTest, TellsWhatItIs) {
  const Outcome outcome = fcu("info --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const nlohmann::json json = nlohmann::json::parse(outcome.text);
  EXPECT_EQ(json["parameters"], 333);
  EXPECT_EQ(json["armed"], false);
  EXPECT_EQ(json["imu"], true);
  EXPECT_FALSE(json["firmware"].get<std::string>().empty());
}

TEST_F(BoardTest, HandsOutAllItsParametersTheSameTwice) {
  const std::string file = testing::TempDir() + "ironbird_board.yaml";
  ASSERT_EQ(fcu("params save " + file).code, 0);
  const Outcome outcome = fcu("params verify " + file);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST_F(BoardTest, IsWatchedForTenSecondsWithoutAMotorTurning) {
  const Outcome outcome = fcu("monitor --seconds 10 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  std::istringstream lines(outcome.text);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const nlohmann::json json = nlohmann::json::parse(line);
    if (!json.contains("output_raw")) continue;
    EXPECT_EQ(json["status"]["armed"], 0);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(json["output_raw"]["values"][k], 0.0) << "motor " << k;
    EXPECT_EQ(json["link"]["silent"], false);
  }
  EXPECT_EQ(count, 10);
}

TEST_F(BoardTest, AnswersItsClockWithinTwentyMilliseconds) {
  const Outcome outcome = fcu("monitor --latency --seconds 10 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_LE(nlohmann::json::parse(outcome.text)["round_trip"]["p50_us"].get<double>(), 20'000.0);
}

TEST_F(BoardTest, IsListedByThePreflight) {
  const Outcome outcome = fcu("preflight");
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.text;
  std::fputs(outcome.text.c_str(), stdout);
}

}  // namespace
}  // namespace ironbird::scenarios
