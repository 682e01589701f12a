// What the program says to logs that are none, lack something or are of something else, seen from outside:
// a clear line, an exit code of its own, and what can be done with the rest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenarios/app/test/program.hpp"
#include "scenarios/replay/test/flight_by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using nlohmann::json;
using test::FlightByHand;
using testing::HasSubstr;

/// What came of a replay by the program.
struct Outcome {
  Said said;
  json verdict;  ///< null: there is none
};

Outcome replay(const std::filesystem::path& log, const TemporaryFolder& folder,
               const std::string& more = "") {
  Outcome outcome;
  outcome.said = run_shell(kProgram + " replay '" + log.string() + "' --no-report --out '" +
                           (folder / "out").string() + "' " + more);
  const std::filesystem::path file = folder / "out" / log.stem() / "verdict.json";
  if (std::filesystem::exists(file)) outcome.verdict = json::parse(std::ifstream(file));
  return outcome;
}

TEST(BadFlightTest, SaysInOneLineWhatIsNoLog) {
  struct NoLog {
    const char* name;
    std::string text;
    const char* says;
  };
  const std::string magic("ULog\x01\x12\x35\x01", 8);
  for (const NoLog& bad :
       {NoLog{"text.ulg", "timestamp,x,y\n1,2,3\n", "is not a ULog"}, NoLog{"empty.ulg", "", "empty"},
        NoLog{"header.ulg", magic, "is cut after 8 bytes"},
        NoLog{"nothing.ulg", magic + std::string(8, '\0'), "no IMU samples"}}) {
    const TemporaryFolder folder;
    const Outcome outcome = replay(folder.write(bad.name, bad.text), folder);
    EXPECT_EQ(outcome.said.exit_code, 2) << bad.name;
    EXPECT_EQ(outcome.said.lines(), 1) << outcome.said.text;
    EXPECT_THAT(outcome.said.text, HasSubstr(bad.name));
    EXPECT_THAT(outcome.said.text, HasSubstr(bad.says));
    EXPECT_TRUE(outcome.verdict.is_null());
  }
  const TemporaryFolder folder;
  EXPECT_EQ(replay(folder / "absent.ulg", folder).said.exit_code, 2);
}

TEST(BadFlightTest, ReadsWhatIsThereOfALogThatIsCut) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> whole = FlightByHand{.seconds = 4.0}.log().bytes();
  const std::string text(whole.begin(), whole.end());
  constexpr std::size_t kCuts = 24;
  std::size_t estimated = 0;
  for (std::size_t k = 0; k < kCuts; ++k) {
    const std::size_t length = text.size() * k / kCuts + k % 7;
    const Outcome outcome = replay(folder.write("cut.ulg", text.substr(0, length)), folder, "--no-log");
    EXPECT_THAT(outcome.said.exit_code, testing::AnyOf(0, 1, 2, 5)) << length << ": " << outcome.said.text;
    EXPECT_GT(outcome.said.lines(), 0) << length;
    const bool started = !outcome.verdict.is_null() && outcome.verdict["checks"][0]["verdict"] == "pass";
    estimated += started ? 1 : 0;
    std::filesystem::remove_all(folder / "out");
  }
  EXPECT_GT(estimated, kCuts / 4) << "what came before the cut is enough to start";
}

TEST(BadFlightTest, SaysWhatAFlightLacks) {
  const TemporaryFolder folder;
  const Outcome no_imu = replay(FlightByHand{.imu = false}.write(folder / "no_imu.ulg"), folder);
  EXPECT_EQ(no_imu.said.exit_code, 2);
  EXPECT_THAT(no_imu.said.text, HasSubstr("no_imu.ulg: has no IMU samples"));
  const Outcome no_gnss = replay(FlightByHand{.gnss = false}.write(folder / "no_gnss.ulg"), folder);
  EXPECT_EQ(no_gnss.said.exit_code, 1);
  EXPECT_THAT(no_gnss.said.text, HasSubstr("it has no GNSS fixes"));
  EXPECT_THAT(no_gnss.said.text, HasSubstr("the estimator never started"));
  EXPECT_EQ(no_gnss.verdict["verdict"], "fail");
  EXPECT_TRUE(no_gnss.verdict["metrics"]["horizontal_difference_rms_m"].is_null()) << "and no zero";
  EXPECT_TRUE(std::filesystem::exists(folder / "out/no_gnss/flight.mcap"));
  const Outcome no_mag = replay(FlightByHand{.mag = false}.write(folder / "no_mag.ulg"), folder);
  EXPECT_EQ(no_mag.said.exit_code, 1);
  EXPECT_THAT(no_mag.said.text, HasSubstr("it has no magnetometer"));
  EXPECT_TRUE(no_mag.verdict["flight"]["magnetometer"].is_null());
  const Outcome alone = replay(FlightByHand{.estimate = false}.write(folder / "alone.ulg"), folder);
  EXPECT_EQ(alone.said.exit_code, 5) << "estimated, but with nothing to compare";
  EXPECT_THAT(alone.said.text, HasSubstr("no estimate of PX4's to compare with"));
}

TEST(BadFlightTest, GoesOnAfterTimesAndNumbersThatCannotBe) {
  const TemporaryFolder folder;
  const Outcome back =
      replay(FlightByHand{.clock_steps_back = true}.write(folder / "back.ulg"), folder, "--window 2:4");
  EXPECT_EQ(back.said.exit_code, 0) << back.said.text;
  EXPECT_THAT(back.said.text, HasSubstr("its clock steps back by 3.0 s after 4.0 s"));
  const Outcome nan = replay(FlightByHand{.no_numbers = true}.write(folder / "nan.ulg"), folder);
  EXPECT_EQ(nan.said.exit_code, 0) << nan.said.text;
  for (const char* says : {"samples of the IMU are not valid", "of its GNSS fixes are no numbers",
                           "of its samples of the field are no numbers",
                           "of its samples of the pressure are no numbers", "of PX4's attitudes are none"})
    EXPECT_THAT(nan.said.text, HasSubstr(says));
}

TEST(BadFlightTest, SaysWhatIsNoFlightOfAMultirotor) {
  const TemporaryFolder folder;
  const Outcome wing = replay(FlightByHand{.vehicle_type = 2}.write(folder / "wing.ulg"), folder);
  EXPECT_EQ(wing.said.exit_code, 0);
  EXPECT_THAT(wing.said.text, HasSubstr("it is the log of a fixed wing"));
  EXPECT_EQ(wing.verdict["flight"]["simulated"], false);
  for (const FlightByHand& simulated :
       {FlightByHand{.hil_state = 1}, FlightByHand{.hitl = 1.0F}, FlightByHand{.board = "PX4_SITL"}}) {
    const Outcome outcome = replay(simulated.write(folder / "simulated.ulg"), folder);
    EXPECT_EQ(outcome.said.exit_code, 0);
    EXPECT_THAT(outcome.said.text, HasSubstr("it is the log of a simulation, not of a flight"));
    EXPECT_EQ(outcome.verdict["flight"]["simulated"], true);
  }
}

TEST(BadFlightTest, TellsInTheVerdictWhatWasCompared) {
  const TemporaryFolder folder;
  const json flight = replay(FlightByHand{}.write(folder / "good.ulg"), folder).verdict["flight"];
  EXPECT_EQ(flight["file"], "good.ulg");
  EXPECT_EQ(flight["recorder"], "PX4 1.14.0 on PX4_FMU_V6C");
  EXPECT_EQ(flight["compared_with"], "PX4");
  EXPECT_EQ(flight["magnetometer"], 0);
  EXPECT_EQ(flight["magnetometer_source"], "the only one of the log");
  EXPECT_THAT(flight["declination_source"], HasSubstr("World Magnetic Model 2020"));
  EXPECT_NEAR(flight["gnss_delay_s"].get<double>(), 0.11, 1e-6);
  EXPECT_EQ(flight["gnss_delay_source"], "EKF2_GPS_DELAY of the log");
  EXPECT_EQ(flight["window_s"], json::array({6.0, 7.0}))
      << "three seconds after take-off, one before the end";
  const json named =
      replay(folder / "good.ulg", folder, "--mag 0 --declination 3 --gnss-delay 0.2 --window 3:6 ")
          .verdict["flight"];
  EXPECT_NEAR(named["declination_rad"].get<double>(), 0.05236, 1e-4);
  EXPECT_EQ(named["window_s"], json::array({3.0, 6.0}));
  for (const char* source :
       {"magnetometer_source", "declination_source", "gnss_delay_source", "window_source"})
    EXPECT_EQ(named[source], "as named");
}

TEST(BadFlightTest, RefusesAFilmWithoutALog) {
  const TemporaryFolder folder;
  const Outcome outcome = replay(FlightByHand{}.write(folder / "good.ulg"), folder, "--no-log --video");
  EXPECT_EQ(outcome.said.exit_code, 2);
  EXPECT_EQ(outcome.said.lines(), 1) << outcome.said.text;
  EXPECT_THAT(outcome.said.text, HasSubstr("--no-log: the film is made from the log"));
}

}  // namespace
}  // namespace ironbird::scenarios
