// What the program says to bad input, seen from outside: one line that names the place, what was found and
// what is allowed; exit code 2; nothing left on the disk.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {
namespace {

constexpr const char* kMission = "title = \"t\"\nduration = \"8 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n";

struct BadInput {
  const char* name;
  std::string scenario;
  std::string options;
  std::vector<std::string> says;  // all of these
};

std::ostream& operator<<(std::ostream& stream, const BadInput& input) {
  return stream << input.name;
}

class BadInputTest : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, GetsOneClearLineAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  const std::string file = folder.write("bad.toml", GetParam().scenario);
  const std::filesystem::path out = folder / "out";
  const Said said =
      run_shell(kProgram + " run " + file + " --out " + out.string() + " " + GetParam().options);
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  for (const std::string& word : GetParam().says) {
    EXPECT_NE(said.text.find(word), std::string::npos) << said.text << "does not say: " << word;
  }
  EXPECT_FALSE(std::filesystem::exists(out / "bad"));
}

std::string mission_and(const std::string& more) {
  return kMission + more;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadInputTest,
    ::testing::Values(
        BadInput{"NotToml", "title = = 3\n", "", {"bad.toml:1:9: "}},
        BadInput{"UnknownKey",
                 mission_and("headign = 3\n"),
                 "",
                 {"bad.toml:5:1: waypoint[0].headign", "did you mean 'heading'"}},
        BadInput{"UnknownTopKey",
                 std::string("duratoin = 3\n") + kMission,
                 "",
                 {"bad.toml:1:1: duratoin", "'duration'"}},
        BadInput{"WrongUnit",
                 "duration = \"8 kg\"\n[[waypoint]]\np_N = [0, 0, -5]\n",
                 "",
                 {"bad.toml:1:12: duration", "'kg'", "needs s"}},
        BadInput{"WrongType", mission_and("heading = true\n"), "", {"bad.toml:5:11: waypoint[0].heading"}},
        BadInput{"NegativeMass",
                 mission_and("[vehicle]\nmass = -1\n"),
                 "",
                 {"bad.toml:6:8: vehicle.mass = -1", "between 0.001 and 10000 kg"}},
        BadInput{"InertiaOfNoBody",
                 mission_and("[vehicle.inertia]\nJxx = 0.5\n"),
                 "",
                 {"bad.toml:", "vehicle.inertia"}},
        BadInput{"InertiaNotPositiveDefinite",
                 mission_and("[vehicle.inertia]\nJxy = 0.2\n"),
                 "",
                 {"bad.toml:", "vehicle.inertia"}},
        BadInput{"RotorWithoutThrust",
                 mission_and("[vehicle.rotor]\nCT = [0, 0, 0]\n"),
                 "",
                 {"bad.toml:", "vehicle.rotor.CT[0] = 0", "must be > 0"}},
        BadInput{"NoRotors",
                 mission_and("[vehicle]\nrotors = []\n"),
                 "",
                 {"bad.toml:", "vehicle.rotors", "between 1 and 8"}},
        BadInput{"WaypointNotANumber",
                 "[[waypoint]]\np_N = [0, nan, -5]\n",
                 "",
                 {"bad.toml:2:11: waypoint[0].p_N[1]", "finite"}},
        BadInput{"NoWaypoints", "duration = 8\n", "", {"bad.toml: waypoint", "[[waypoint]]", "[[event]]"}},
        BadInput{"PeriodNotAMultiple",
                 mission_and("[autopilot.controller]\nperiod = \"3 ms\"\n"),
                 "",
                 {"bad.toml:", "autopilot.controller.period = 3", "multiple of the tick", "2.5", "5"}},
        BadInput{"UnknownModule",
                 mission_and("[autopilot.estimator]\nkind = \"ekff\"\n"),
                 "",
                 {"bad.toml:", "autopilot.estimator.kind = \"ekff\"", "ekf, error_state"}},
        BadInput{"UnknownParameter",
                 mission_and("[autopilot.controller]\nmax_rol = 1\n"),
                 "",
                 {"bad.toml:", "max_rol", "max_roll"}},
        BadInput{"UnknownVehicle",
                 std::string("vehicle = \"models/x65\"\n") + kMission,
                 "",
                 {"bad.toml:1:11: vehicle = \"models/x65\"", "models/x650"}},
        BadInput{"VehicleOfNoKind", std::string("vehicle = 3\n") + kMission, "", {"bad.toml:1:11: vehicle"}},
        BadInput{"FieldThatIsMissing",
                 std::string("field = \"models/fields/moon.xml\"\n") + kMission,
                 "--video",
                 {"bad.toml:1:9: field", "moon.xml"}},
        BadInput{"EventOfTwoThings",
                 mission_and("[[event]]\nat = 1\nrequest = \"land\"\npilot = \"arm\"\n"),
                 "",
                 {"bad.toml:", "event[0]", "exactly one"}},
        BadInput{"RequestOfNoName",
                 mission_and("[[event]]\nat = 1\nrequest = \"lnad\"\n"),
                 "",
                 {"bad.toml:7:11: event[0].request", "land"}},
        BadInput{"CheckOfNoSignal",
                 mission_and("[[check]]\nname = \"c\"\nsignal = \"truth.p_NB\"\nstays_below = \"1 m\"\n"),
                 "",
                 {"bad.toml:", "truth.p_NB", "truth.p_NB_N"}},
        BadInput{"SettingWithoutValue", kMission, "--set duration", {"path=value"}},
        BadInput{"SettingOfNoName", kMission, "--set plant.engin=ode", {"--set", "plant.engin", "'engine'"}},
        BadInput{"SeedThatIsNone", kMission, "--seed seven", {"--seed seven", "1:20"}},
        BadInput{"FilmWithoutLog", kMission, "--no-log --video", {"--no-log"}},
        BadInput{"IncludeThatIsMissing",
                 std::string("include = [\"none.toml\"]\n") + kMission,
                 "",
                 {"bad.toml:1:", "none.toml"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(BadFileTest, MissingScenarioIsNamed) {
  const Said said = run_shell(kProgram + " run /nowhere/at_all.toml");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.text, "/nowhere/at_all.toml: cannot be opened\n");
}

TEST(BadFileTest, AllFindingsAreToldAtOnce) {
  const TemporaryFolder folder;
  const std::string file = folder.write("bad.toml", std::string("duratoin = 3\nseed = -1\n") + kMission);
  const Said said = run_shell(kProgram + " check " + file);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 2) << said.text;
}

TEST(BadFileTest, AVehicleWithoutASceneIsNoticedBeforeTheFlightWhenItIsToBeFilmed) {
  const TemporaryFolder folder;
  run_shell("cp -r models/x650 " + folder.text() + "/plain && rm " + folder.text() + "/plain/scene.xml");
  const std::string file = folder.write("film.toml", kMission);
  const std::string out = (folder / "out").string();
  const Said said = run_shell(kProgram + " run " + file + " --video --set vehicle=" + folder.text() +
                              "/plain --out " + out);
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("plain/scene.xml"), std::string::npos) << said.text;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/film"));
}

TEST(BadFileTest, AMeshThatIsMissingIsNoticedBeforeTheFlightWhenItIsToBeFilmed) {
  const TemporaryFolder folder;
  run_shell("cp -r models/x650 " + folder.text() + "/meshed");
  folder.write("meshed/scene.xml",
               "<mujoco><asset><mesh name='hull' file='hull.stl'/></asset>"
               "<worldbody><body name='vehicle'><geom type='mesh' mesh='hull'/></body></worldbody></mujoco>");
  const std::string file = folder.write("film.toml", kMission);
  const Said said = run_shell(kProgram + " run " + file + " --video --set vehicle=" + folder.text() +
                              "/meshed --out " + folder.text() + "/out");
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("hull.stl"), std::string::npos) << said.text;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/film"));
}

}  // namespace
}  // namespace ironbird::scenarios
