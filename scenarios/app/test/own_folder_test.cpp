// Scenarios and vehicles in a folder of their own, outside the tree, and started from yet another.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scenarios/app/test/bad_input.hpp"

namespace ironbird::scenarios {
namespace {

class OwnFolderTest : public ::testing::Test {
 protected:
  OwnFolderTest() {
    run_shell("cp -r models/x650 " + (folder_ / "my_quad").string() + " && mkdir " +
              (folder_ / "missions").string());
  }

  /// Runs the program from a folder that has nothing to do with the scenario nor with the tree.
  Said from_elsewhere(const std::string& words) const {
    return run_shell("cd / && " + kProgram + " " + words);
  }

  std::string out() const { return " --out " + (folder_ / "out").string(); }

  TemporaryFolder folder_;
};

TEST_F(OwnFolderTest, FliesTheTreesVehicleByItsName) {
  const std::string file = folder_.write("a.toml", std::string("vehicle = \"models/rosflight_multirotor\"\n"
                                                               "field = \"models/fields/yard.xml\"\n") +
                                                       kMission);
  const Said said = from_elsewhere("run " + file + " --no-report" + out());
  EXPECT_EQ(said.exit_code, 5) << said.text << "it has no checks";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/a/verdict.json")) << said.text;
}

TEST_F(OwnFolderTest, FliesAVehicleBesideTheScenarioOrRelativeToIt) {
  const std::string beside = folder_.write("b.toml", std::string("vehicle = \"my_quad\"\n") + kMission);
  const std::string above =
      folder_.write("missions/c.toml", std::string("vehicle = \"../my_quad\"\n") + kMission);
  const Said said = from_elsewhere("check " + beside + " " + above);
  EXPECT_EQ(said.exit_code, 0) << said.text;
}

TEST_F(OwnFolderTest, TakesAVehicleOnTheCommandLineFromTheWorkingFolder) {
  const std::string file = folder_.write("missions/d.toml", kMission);
  const Said said = run_shell("cd " + folder_.text() + " && " + kProgram + " run missions/d.toml --no-log" +
                              out() + " --set vehicle=my_quad");
  EXPECT_EQ(said.exit_code, 5) << said.text;
}

TEST_F(OwnFolderTest, IncludesAMissionOfTheTree) {
  const std::string file = folder_.write(
      "e.toml", "include = [\"scenarios/library/missions/take_off_and_land.toml\"]\nvehicle = \"my_quad\"\n");
  EXPECT_EQ(from_elsewhere("check " + file).exit_code, 0);
}

TEST_F(OwnFolderTest, NamesTheVehiclesThatThereAreWhenOneIsMissing) {
  const std::string file = folder_.write("f.toml", std::string("vehicle = \"my_qud\"\n") + kMission);
  const Said said = from_elsewhere("check " + file);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("f.toml:1:11: vehicle = \"my_qud\""), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("there are: models/rosflight_multirotor, models/x650, my_quad"), std::string::npos)
      << said.text;
}

TEST_F(OwnFolderTest, NamesTheFieldsThatThereAreWhenOneIsMissing) {
  const std::string file = folder_.write("g.toml", std::string("field = \"yrd.xml\"\n") + kMission);
  const Said said = from_elsewhere("check " + file);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.text.find("there are: models/fields/flat.xml"), std::string::npos) << said.text;
}

TEST_F(OwnFolderTest, DrawsALogWithTheVehicleBesideItsScenario) {
  const std::string file = folder_.write("h.toml", std::string("vehicle = \"my_quad\"\n") + kMission +
                                                       "[[snapshot]]\nname = \"start\"\nat = \"1 s\"\n");
  ASSERT_EQ(from_elsewhere("run " + file + " --no-report" + out()).exit_code, 5);
  const std::string pictures = (folder_ / "pictures").string();
  const Said said =
      from_elsewhere("snapshot " + (folder_ / "out/h/flight.mcap").string() + " --out " + pictures);
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_TRUE(std::filesystem::exists(pictures + "/start.png"));
}

TEST_F(OwnFolderTest, SaysWhenTheVehicleOfALogIsGone) {
  const std::string file = folder_.write("i.toml", std::string("vehicle = \"my_quad\"\n") + kMission);
  ASSERT_EQ(from_elsewhere("run " + file + " --no-report" + out()).exit_code, 5);
  std::filesystem::remove_all(folder_ / "my_quad");
  const Said said = from_elsewhere("video " + (folder_ / "out/i/flight.mcap").string() + out());
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("vehicle \"my_quad\" that was flown is not found"), std::string::npos)
      << said.text;
}

}  // namespace
}  // namespace ironbird::scenarios
