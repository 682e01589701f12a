// Scenes that cannot be drawn: all of it is known before the flight.

#include <array>
#include <cstdint>
#include <fstream>
#include <string>

#include "scenarios/app/test/bad_input.hpp"

namespace ironbird::scenarios {
namespace {

TEST(BadSceneTest, AFieldThatCannotBeDrawnIsNamed) {
  const TemporaryFolder folder;
  const std::string field =
      folder.write("moon.xml", "<mujoco><worldbody><geom type='bal'/></worldbody></mujoco>");
  const std::string file = folder.write("top.toml", "field = \"" + field + "\"\n" + kMission);
  const Said said = run_shell(kProgram + " check " + file);
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("top.toml:1:9: field = "), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("cannot be drawn: " + field + ":1: "), std::string::npos) << said.text;
}

TEST(BadSceneTest, AVehicleWithoutASceneIsNoticedBeforeTheFlightWhenItIsToBeFilmed) {
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

TEST(BadSceneTest, AMeshThatIsMissingIsNoticedBeforeTheFlightWhenItIsToBeFilmed) {
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

struct Scene {
  const char* name;
  const char* text;               // with one body, the vehicle
  std::vector<std::string> says;  // nothing: it can be drawn
};

class SceneTest : public ::testing::TestWithParam<Scene> {
 protected:
  SceneTest() {
    run_shell("cp -r models/x650 " + folder_.text() + "/own && mkdir " + folder_.text() + "/own/parts");
    folder_.write("own/scene.xml", GetParam().text);
    folder_.write("own/broken.stl", "solid nothing");
    write_tetrahedron("own/hull.stl");
    write_tetrahedron("own/parts/arm.stl");
    file_ = folder_.write("own.toml", std::string("vehicle = \"own\"\n") + kMission);
  }

  void write_tetrahedron(const std::string& name) const {
    constexpr float kCorners[4][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}};
    std::string bytes(80, ' ');
    const auto put = [&](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(std::uint32_t{4});
    for (const auto& face : kFaces) {
      put(std::array<float, 3>{});
      for (const int corner : face) put(kCorners[corner]);
      put(std::uint16_t{0});
    }
    folder_.write(name, bytes);
  }

  TemporaryFolder folder_;
  std::string file_;
};

TEST_P(SceneTest, IsJudgedByCheckInOneLine) {
  const Said said = run_shell("cd / && " + kProgram + " check " + file_);
  EXPECT_EQ(said.exit_code, GetParam().says.empty() ? 0 : 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  for (const std::string& word : GetParam().says)
    EXPECT_NE(said.text.find(word), std::string::npos) << said.text << "does not say: " << word;
  EXPECT_EQ(said.text.find("column = "), std::string::npos) << said.text << "speaks of the engine's own";
}

INSTANTIATE_TEST_SUITE_P(
    Cases, SceneTest,
    ::testing::Values(
        Scene{"MeshBesideIt",
              "<mujoco><asset><mesh name='hull' file='hull.stl'/></asset><worldbody><body name='vehicle'>"
              "<freejoint/><geom type='mesh' mesh='hull'/></body></worldbody></mujoco>",
              {}},
        Scene{"MeshInItsMeshFolder",
              "<mujoco><compiler meshdir='parts'/><asset><mesh name='arm' file='arm.stl'/></asset><worldbody>"
              "<body name='vehicle'><freejoint/><geom type='mesh' mesh='arm'/></body></worldbody></mujoco>",
              {}},
        Scene{"MeshThatIsCommentedOut",
              "<mujoco><!-- <mesh file='none.stl'/> --><worldbody><body name='vehicle'><freejoint/>"
              "<geom type='box' size='1 1 1'/></body></worldbody></mujoco>",
              {}},
        Scene{"MeshThatIsMissing",
              "<mujoco>\n<asset>\n<mesh name='hull' file='hul.stl'/></asset><worldbody><body name='vehicle'>"
              "<freejoint/><geom type='mesh' mesh='hull'/></body></worldbody></mujoco>",
              {"own.toml:1:11: vehicle = \"own\"", "own/scene.xml:3: mesh \"hul.stl\"", "own/hul.stl",
               "meshdir"}},
        Scene{"TextureThatIsMissing",
              "<mujoco><asset><texture name='t' type='2d' file='t.png'/></asset><worldbody><body "
              "name='vehicle'>"
              "<freejoint/><geom type='box' size='1 1 1'/></body></worldbody></mujoco>",
              {"own/scene.xml:1: texture \"t.png\"", "own/t.png"}},
        Scene{"IncludeThatIsMissing",
              "<mujoco><include file='more.xml'/><worldbody><body name='vehicle'><freejoint/>"
              "<geom type='box' size='1 1 1'/></body></worldbody></mujoco>",
              {"own/scene.xml:1: include \"more.xml\""}},
        Scene{"MeshThatIsNone",
              "<mujoco><asset><mesh name='hull' file='broken.stl'/></asset><worldbody><body name='vehicle'>"
              "<freejoint/><geom type='mesh' mesh='hull'/></body></worldbody></mujoco>",
              {"own/scene.xml:1: invalid header in STL file", "broken.stl"}},
        Scene{"AttributeOfNoName",
              "<mujoco>\n<worldbody><body name='vehicle'><freejoint/><geom type='box' "
              "siz='1'/></body></worldbody>"
              "</mujoco>",
              {"own/scene.xml:2: unrecognized attribute: 'siz' in an element 'geom'"}},
        Scene{"NoXml", "<mujoco>\n<worldbody", {"own/scene.xml: is no well-formed XML", "in line 2"}},
        Scene{"BodyOfAnotherName",
              "<mujoco><worldbody><body name='plane'><freejoint/><geom type='box' size='1 1 "
              "1'/></body></worldbody>"
              "</mujoco>",
              {"own/scene.xml: has no body named 'vehicle'"}},
        Scene{"BodyThatIsFixed",
              "<mujoco><worldbody><body name='vehicle'><geom type='box' size='1 1 "
              "1'/></body></worldbody></mujoco>",
              {"own/scene.xml:1: the body 'vehicle' has no free joint"}},
        Scene{"RotorThatDoesNotTurn",
              "<mujoco><worldbody><body name='vehicle'><freejoint/><geom type='box' size='1 1 1'/><body "
              "name='rotor_0'><geom type='box' size='1 1 1'/></body></body></worldbody></mujoco>",
              {"own/scene.xml:1: the body 'rotor_0' has no hinge of its name"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(BadSceneTest, AMeshBesideTheSceneIsDrawn) {
  const TemporaryFolder folder;
  run_shell("cp -r models/x650 " + folder.text() + "/own");
  std::ofstream(folder / "own/dot.obj")
      << "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 3 2 4\n";
  folder.write("own/scene.xml",
               "<mujoco><asset><mesh name='hull' file='dot.obj'/></asset><worldbody><body name='vehicle'>"
               "<freejoint/><geom type='mesh' mesh='hull'/></body></worldbody></mujoco>");
  const std::string file = folder.write(
      "own.toml", std::string("vehicle = \"own\"\n") + kMission + "[[snapshot]]\nname = \"start\"\n");
  const Said said = run_shell("cd / && " + kProgram + " run " + file + " --snapshots --out " + folder.text());
  EXPECT_EQ(said.exit_code, 5) << said.text << "it has no checks";
  EXPECT_TRUE(std::filesystem::exists(folder / "own/snapshots/start.png")) << said.text;
}

TEST(BadSceneTest, CheckTakesAMissingSceneForAFindingOnlyWhenItIsToBeDrawn) {
  const TemporaryFolder folder;
  run_shell("cp -r models/x650 " + folder.text() + "/plain && rm " + folder.text() + "/plain/scene.xml");
  const std::string file = folder.write("a.toml", std::string("vehicle = \"plain\"\n") + kMission);
  EXPECT_EQ(run_shell(kProgram + " check " + file).exit_code, 0);
  const Said said = run_shell(kProgram + " check " + file + " --video");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
}

TEST(CheckVerbTest, TakesSettingsAndSeedsAsRunDoes) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.toml", kMission);
  EXPECT_EQ(run_shell(kProgram + " check " + file + " --set plant.engine=ode --seed 1:20").exit_code, 0);
  const Said setting = run_shell(kProgram + " check " + file + " --set plant.engine=oed");
  EXPECT_EQ(setting.exit_code, 2);
  EXPECT_NE(setting.text.find("--set plant.engine=oed: plant.engine"), std::string::npos) << setting.text;
  EXPECT_EQ(run_shell(kProgram + " check " + file + " --seed seven").exit_code, 2);
  EXPECT_EQ(run_shell(kProgram + " check " + file + " --seed 9223372036854775807").exit_code, 0);
}

}  // namespace
}  // namespace ironbird::scenarios
