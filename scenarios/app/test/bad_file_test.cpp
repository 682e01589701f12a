// Files that are missing, odd or wrong, and what is told about several of them.

#include <fstream>
#include <iterator>
#include <string>

#include "scenarios/app/test/bad_input.hpp"

namespace ironbird::scenarios {
namespace {

TEST(BadFileTest, MissingScenarioIsNamed) {
  const Said said = run_shell(kProgram + " run /nowhere/at_all.toml");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.text, "/nowhere/at_all.toml: cannot be opened: there is no such file\n");
}

TEST(BadFileTest, MissingScenarioThatIsInTheLibraryIsFound) {
  const TemporaryFolder folder;
  const std::string file = (folder / "three_waypoint.toml").string();
  const Said said = run_shell(kProgram + " run " + file);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.text, file +
                           ": cannot be opened: there is no such file; did you mean "
                           "'scenarios/library/paper/three_waypoints.toml'?\n");
}

/// Says so of the mission when these settings are made.
testing::AssertionResult has_no_finding(const std::string& settings) {
  const TemporaryFolder folder;
  const Said said = run_shell(kProgram + " check " + folder.write("a.toml", kMission) + settings);
  return (said.exit_code == 0 ? testing::AssertionSuccess() : testing::AssertionFailure()) << said.text;
}

TEST(BadFileTest, AUnitElsewhereNeedNotBeThereForACheck) {
  EXPECT_TRUE(has_no_finding(" --set fcu.kind=hil --set fcu.line=/nowhere/unit --set fcu.motors=output_raw"));
}

TEST(BadFileTest, TheTickOfARealVehicleNeedNotSuitSimulatedSensors) {
  constexpr const char* kTick = " --set fcu.tick='2 ms'";
  EXPECT_TRUE(has_no_finding(std::string(" --set fcu.kind=serial --set fcu.line=/nowhere/unit") + kTick));
  EXPECT_FALSE(has_no_finding(kTick)) << "the simulated sensors sample every 2.5 ms";
}

TEST(BadFileTest, AllFindingsAreToldAtOnce) {
  const TemporaryFolder folder;
  const std::string file = folder.write("bad.toml", std::string("duratoin = 3\nseed = -1\n") + kMission);
  const Said said = run_shell(kProgram + " check " + file);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 3) << said.text;
  EXPECT_NE(said.text.find("\n2 findings in 1 of 1 file\n"), std::string::npos) << said.text;
}

TEST(BadFileTest, CheckGoesOnBehindAWrongFile) {
  const TemporaryFolder folder;
  const std::string wrong = folder.write("wrong.toml", "title = = 3\n");
  const std::string right = folder.write("right.toml", kMission);
  const Said said =
      run_shell(kProgram + " check " + wrong + " " + (folder / "none.toml").string() + " " + right);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 4) << said.text;
  EXPECT_NE(said.text.find("right.toml: no finding\n2 findings in 2 of 3 files\n"), std::string::npos)
      << said.text;
}

TEST(BadFileTest, TheOthersFlyWhenOneOfSeveralScenariosIsWrong) {
  const TemporaryFolder folder;
  const std::string right = folder.write("right.toml", kMission);
  const std::string wrong = folder.write("wrong.toml", "title = = 3\n");
  const std::string out = (folder / "out").string();
  const Said said = run_shell(kProgram + " run " + right + " " + wrong + " --out " + out);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.text.find(wrong + ":1:9: "), 0U) << said.text;
  EXPECT_NE(said.text.find("wrong: no verdict, exit code 2"), std::string::npos) << said.text;
  EXPECT_TRUE(std::filesystem::exists(out + "/right/flight.mcap"));
  EXPECT_FALSE(std::filesystem::exists(out + "/wrong"));
}

TEST(BadFileTest, AVehicleWithoutItsSensorsIsRefused) {
  const TemporaryFolder folder;
  const std::string vehicle = (folder / "vehicle").string();
  const std::string mission = folder.write("mission.toml", kMission);
  const Said said = run_shell("cp -r models/x650 " + vehicle + " && rm " + vehicle + "/sensors.toml && " +
                              kProgram + " run " + mission + " --no-log --set vehicle=" + vehicle);
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_NE(said.text.find("there is no " + vehicle + "/sensors.toml"), std::string::npos) << said.text;
}

struct OddFile {
  const char* name;
  std::string make;  // what the shell does; F is the file
  const char* says;
};

class OddFileTest : public ::testing::TestWithParam<OddFile> {};

TEST_P(OddFileTest, IsRefusedInOneLine) {
  const TemporaryFolder folder;
  const std::string file = (folder / "odd.toml").string();
  const Said said = run_shell("F=" + file + "; " + GetParam().make + "; " + kProgram + " check $F");
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find(GetParam().says), std::string::npos) << said.text;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OddFileTest,
    ::testing::Values(
        OddFile{"Folder", "mkdir $F", "odd.toml: is a folder, must be a TOML file"},
        OddFile{"Device", "F=/dev/null", "/dev/null: is no regular file"},
        OddFile{"Empty", ": > $F", "odd.toml:1:1: waypoint: there is none"},
        OddFile{"Binary", "head -c 4096 " + kProgram + " > $F", "odd.toml:1:"},
        OddFile{"Zeros", "truncate -s 1G $F", "has 1073741824 bytes, a configuration has at most"},
        OddFile{"NoUtf8", "printf 'title = \"\\377\"\\n' > $F", "odd.toml:1:9: "},
        OddFile{"Utf16", "printf '\\377\\376t\\0' > $F", "odd.toml:1:1: "},
        OddFile{"IncludesItself", "echo 'include = [\"odd.toml\"]' > $F", "odd.toml:1:12: include = "},
        OddFile{"IncludesAFolder", "echo 'include = [\"models\"]' > $F",
                "models: is a folder, must be a TOML file"},
        OddFile{"NameOfNoEnd", "F=$F$(printf 'x%.0s' $(seq 300))", "cannot be opened: File name"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(BadFileTest, AByteOrderMarkAndWindowsLinesAreTaken) {
  const TemporaryFolder folder;
  const std::string file = folder.write("windows.toml",
                                        "\xEF\xBB\xBF"
                                        "duration = 8\r\n[[waypoint]]\r\np_N = [0, 0, -5]\r\n");
  const Said said = run_shell(kProgram + " check " + file);
  EXPECT_EQ(said.exit_code, 0) << said.text;
}

TEST(BadFileTest, AFindingInAnIncludedFileNamesThatFile) {
  const TemporaryFolder folder;
  folder.write("base.toml", "\nduration = \"8 kg\"\n");
  const std::string file =
      folder.write("top.toml", "include = [\"base.toml\"]\n[[waypoint]]\np_N = [0, 0, -5]\n");
  const Said said = run_shell(kProgram + " check " + file);
  EXPECT_NE(said.text.find("base.toml:2:12: duration = '8 kg'"), std::string::npos) << said.text;
}

}  // namespace
}  // namespace ironbird::scenarios
