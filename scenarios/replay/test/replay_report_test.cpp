// The report of a replay, by the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "scenarios/app/test/program.hpp"
#include "scenarios/record/log.hpp"
#include "scenarios/replay/test/flight_by_hand.hpp"

namespace ironbird::scenarios {
namespace {

using test::FlightByHand;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string report_of(const FlightByHand& flight, const TemporaryFolder& folder, const std::string& more) {
  const std::string log = flight.write(folder / "flown.ulg").string();
  const Said said =
      run_shell(kProgram + " replay '" + log + "' --out '" + (folder / "out").string() + "' " + more);
  EXPECT_EQ(said.exit_code, 0) << said.text;
  return text_of(folder / "out/flown/report.html");
}

class ReplayReportOfTest : public testing::TestWithParam<std::string> {};

TEST_P(ReplayReportOfTest, ShowsGatesRefusedFixesPhasesBiasesAndWhatItIsOf) {
  const TemporaryFolder folder;
  const std::string kind = "--set autopilot.estimator.kind=" + GetParam();
  const std::string page = report_of({.jump = true}, folder, kind);
  EXPECT_THAT(page, HasSubstr("fix, north: gate \u00b1"));
  EXPECT_THAT(page, HasSubstr("compass: gate \u00b1"));
  EXPECT_THAT(page, HasSubstr("class=\"curve c0 bound\" data-name=\"gate\" d=\"M"));
  EXPECT_THAT(page, HasSubstr("class=\"curve refused dots\" data-name=\"refused\" d=\"M"));
  for (const char* phase : {"disarmed", "on the ground", "mission", "return"})
    EXPECT_THAT(page, HasSubstr("<title>" + std::string(phase) + "</title>")) << phase;
  EXPECT_THAT(page, HasSubstr("gyro, front"));
  EXPECT_THAT(page, HasSubstr("3\u03c3"));
  EXPECT_THAT(page, HasSubstr("PX4 1.14.0 on PX4_FMU_V6C"));
  EXPECT_THAT(page, HasSubstr("110 ms old on arrival (EKF2_GPS_DELAY of the log)"));
  EXPECT_THAT(page, HasSubstr("World Magnetic Model 2020"));
  EXPECT_THAT(page, HasSubstr("<i>m/s</i></b><span>velocity difference, rms"));
}

INSTANTIATE_TEST_SUITE_P(Both, ReplayReportOfTest, testing::Values("ekf", "error_state"),
                         [](const auto& kind) { return kind.param; });

TEST(ReplayReportTest, HasARefusedMarkOnlyWhereSomethingWasRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(report_of({}, folder, ""), Not(HasSubstr("refused dots")));
}

TEST(ReplayReportTest, ShowsTheGateOfTheInnovationThatIsShown) {
  const TemporaryFolder folder;
  report_of({.jump = true}, folder, "");
  const Log log = Log::read(folder / "out/flown/flight.mcap");
  const LogTopic* const probe = log.topic("/autopilot/estimator/ekf/probe");
  ASSERT_NE(probe, nullptr);
  const std::vector<double>& innovation = probe->column("innovation_position_x");
  const std::vector<double>& gate = probe->column("gate_position_x");
  const std::vector<double>& rejected = probe->column("rejected_position");
  double refused_by = 0.0;
  for (std::size_t k = 1; k < rejected.size(); ++k) {
    if (rejected[k] > rejected[k - 1]) refused_by = innovation[k];
    const bool beyond = gate[k] > 0.0 && std::abs(innovation[k]) > gate[k];
    EXPECT_FALSE(beyond && rejected[k] < 1.0) << "beyond its gate and believed";
  }
  constexpr double kNorth = 1e-3 * 111'195.0;  // m, of a thousandth of a degree
  EXPECT_NEAR(refused_by, kNorth, 0.5);
}

TEST(ReplayReportTest, TellsThePhasesOfTheRecorderInTheLog) {
  const TemporaryFolder folder;
  report_of({}, folder, "");
  const Log log = Log::read(folder / "out/flown/flight.mcap");
  const LogTopic* const phase = log.topic("/recorded/phase");
  ASSERT_NE(phase, nullptr);
  EXPECT_THAT(phase->column("armed"), ElementsAre(0.0, 1.0, 1.0, 1.0));
  EXPECT_THAT(phase->column("airborne"), ElementsAre(0.0, 0.0, 1.0, 1.0));
  EXPECT_THAT(phase->texts("mode"), ElementsAre("mission", "mission", "mission", "return"));
  EXPECT_THAT(phase->time(), ElementsAre(0.0, 1.0, FlightByHand::kTakeOff, FlightByHand::kReturn));
}

}  // namespace
}  // namespace ironbird::scenarios
