#include "scenarios/config/include.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

class IncludeTest : public ::testing::Test {
 protected:
  IncludeTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(::testing::TempDir()) / (std::string("include_") + test->name());
    std::filesystem::remove_all(root_);
  }

  std::string file(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
    return (root_ / name).string();
  }

  toml::table load(const std::string& name) const { return load_toml(root_ / name); }

  std::string error(const std::string& name) const {
    try {
      load(name);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path root_;
};

TEST_F(IncludeTest, LetsOwnValuesWinTablesMergeAndArraysReplace) {
  file("a.toml", "include = [\"b.toml\"]\n[plant]\nstep = 1\nlist = [1]\n");
  file("b.toml", "[plant]\nstep = 2\nengine = \"ode\"\nlist = [2, 3]\n[fcu]\nkind = \"virtual\"\n");
  const toml::table table = load("a.toml");
  EXPECT_EQ(table["plant"]["step"].value<int>(), 1);
  EXPECT_EQ(table["plant"]["engine"].value<std::string>(), "ode");
  EXPECT_EQ(table["plant"]["list"].as_array()->size(), 1u);
  EXPECT_EQ(table["fcu"]["kind"].value<std::string>(), "virtual");
  EXPECT_FALSE(table.contains("include"));
}

TEST_F(IncludeTest, LetsTheLaterOfTwoIncludedFilesWin) {
  file("a.toml", "include = [\"b.toml\", \"c.toml\"]\n");
  file("b.toml", "x = 1\ny = 1\n");
  file("c.toml", "x = 2\n");
  EXPECT_EQ(load("a.toml")["x"].value<int>(), 2);
  EXPECT_EQ(load("a.toml")["y"].value<int>(), 1);
}

TEST_F(IncludeTest, KeepsFileAndLineOfEveryNode) {
  const std::string a = file("a.toml", "include = [\"b.toml\"]\n\n[plant]\nstep = 1\n");
  const std::string b = file("b.toml", "[plant]\nengine = \"ode\"\n[[waypoint]]\nspeed = 3\n");
  const toml::table table = load("a.toml");
  EXPECT_EQ(location(table["plant"]["step"].node()->source()), a + ":4:8");
  EXPECT_EQ(location(table["plant"]["engine"].node()->source()), b + ":2:10");
  EXPECT_EQ(location(table["waypoint"][0]["speed"].node()->source()), b + ":4:9");
}

TEST_F(IncludeTest, LooksBesideTheFileThenInTheFoldersAboveIt) {
  file("scenarios/a.toml", "include = [\"near.toml\", \"models/far.toml\", \"../models/up.toml\"]\n");
  file("scenarios/near.toml", "near = 1\n");
  file("models/far.toml", "far = 1\n");
  file("models/up.toml", "up = 1\n");
  const toml::table table = load("scenarios/a.toml");
  EXPECT_TRUE(table.contains("near") && table.contains("far") && table.contains("up"));
}

TEST_F(IncludeTest, PrintsATableThatReadsBackTheSame) {
  const toml::table table = parse_toml("text = \"\"\"\n\n\nends here\"\"\"\nother = 'it\\n'\n", "a.toml");
  EXPECT_EQ(table["text"].value<std::string>(), "\n\nends here");
  EXPECT_EQ(parse_toml(print_toml(table), "b.toml"), table) << print_toml(table);
}

TEST_F(IncludeTest, MayReachOneFileOnTwoWays) {
  file("a.toml", "include = [\"b.toml\", \"c.toml\"]\n");
  file("b.toml", "include = [\"d.toml\"]\n");
  file("c.toml", "include = [\"d.toml\"]\n");
  file("d.toml", "x = 1\n");
  EXPECT_EQ(load("a.toml")["x"].value<int>(), 1);
}

TEST_F(IncludeTest, RefusesACircle) {
  file("a.toml", "include = [\"b.toml\"]\n");
  const std::string b = file("b.toml", "\ninclude = [\"a.toml\"]\n");
  EXPECT_EQ(error("a.toml"), b + ":2:12: include = \"" + (root_ / "a.toml").string() +
                                 "\": the files include each other in a circle");
}

TEST_F(IncludeTest, RefusesFilesThatDoubleEachOther) {
  constexpr int kFiles = 40;  // 2^40 readings
  for (int i = 0; i < kFiles; ++i) {
    const std::string next = "\"" + std::to_string(i + 1) + ".toml\"";
    file(std::to_string(i) + ".toml", "include = [" + next + ", " + next + "]\n");
  }
  file(std::to_string(kFiles) + ".toml", "x = 1\n");
  EXPECT_THAT(error("0.toml"),
              HasSubstr(": more than 256 files would be read, each as often as it is included"));
}

TEST_F(IncludeTest, ReadsAsManyFilesAsAnyoneHas) {
  std::string names;
  for (int i = 0; i < 255; ++i) {
    const std::string name = "part_" + std::to_string(i) + ".toml";
    file(name, "x_" + std::to_string(i) + " = 1\n");
    names += "\"" + name + "\", ";
  }
  file("a.toml", "include = [" + names + "]\n");
  EXPECT_EQ(load("a.toml").size(), 255U);
}

TEST_F(IncludeTest, SaysWhoAskedForAMissingFile) {
  const std::string a = file("a.toml", "include = [\"b.toml\"]\n");
  EXPECT_EQ(error("a.toml"), a + ":1:12: " + (root_ / "b.toml").string() +
                                 ": cannot be opened: there is no such file; did you mean '" + a + "'?");
  EXPECT_EQ(error("missing.toml"),
            (root_ / "missing.toml").string() + ": cannot be opened: there is no such file");
}

TEST_F(IncludeTest, RefusesAFolder) {
  const std::string a = file("a.toml", "include = [\"inner\"]\n");
  file("inner/b.toml", "");
  EXPECT_EQ(error("a.toml"),
            a + ":1:12: " + (root_ / "inner").string() + ": is a folder, must be a TOML file");
}

TEST_F(IncludeTest, RefusesAFileThatIncludesItself) {
  file("a.toml", "include = [\"./a.toml\"]\n");
  EXPECT_THAT(error("a.toml"), HasSubstr("a.toml:1:12: include = "));
  EXPECT_THAT(error("a.toml"), HasSubstr("in a circle"));
}

TEST_F(IncludeTest, RefusesATableWhereTheOtherFileHasNone) {
  const std::string a = file("a.toml", "include = [\"b.toml\"]\nfcu = \"x\"\n");
  const std::string b = file("b.toml", "[fcu]\nkind = 1\n");
  EXPECT_EQ(error("a.toml"),
            a + ":2:7: fcu: is a value here and a table, [fcu], in " + b + ":1:1; write it as there");
  const std::string c = file("c.toml", "include = [\"d.toml\"]\n[a.check]\nname = \"x\"\n");
  const std::string d = file("d.toml", "[[a.check]]\nname = \"y\"\n");
  EXPECT_EQ(error("c.toml"), c + ":2:1: a.check: is a table, [a.check], here and an array in " + d +
                                 ":1:1; write it as there");
}

TEST_F(IncludeTest, TakesAFileWithAByteOrderMarkAndReturns) {
  file("a.toml", "\xEF\xBB\xBFx = 1\r\ny = 2\r\n");
  EXPECT_EQ(load("a.toml")["y"].value<int>(), 2);
}

TEST_F(IncludeTest, SaysWhereAFileIsNoText) {
  const std::string a = file("a.toml", "x = 1\ny = \"\xFF\xFE\"\n");
  EXPECT_THAT(error("a.toml"), HasSubstr(a + ":2:"));
  const std::string b = file("b.toml", std::string("\x7F"
                                                   "ELF\0\0\1",
                                                   7));
  EXPECT_THAT(error("b.toml"), HasSubstr(b + ":1:1: "));
}

TEST_F(IncludeTest, RefusesWhatIsNoListOfPaths) {
  const std::string a = file("a.toml", "include = \"b.toml\"\n");
  EXPECT_EQ(error("a.toml"), a + ":1:11: include: must be an array of paths");
  const std::string b = file("b.toml", "include = [1]\n");
  EXPECT_EQ(error("b.toml"), b + ":1:12: include: must be an array of paths");
}

TEST_F(IncludeTest, RefusesAnEmptyPath) {
  const std::string a = file("a.toml", "include = [\"\"]\n");
  EXPECT_EQ(error("a.toml"), a + ":1:12: include = [\"\"]: must name a file");
}

TEST_F(IncludeTest, SaysWhereAFileIsNoToml) {
  const std::string a = file("a.toml", "x = 1\ny = = 2\n");
  EXPECT_THAT(error("a.toml"), HasSubstr(a + ":2:5: "));
}

toml::table with(std::string_view path, std::string_view text) {
  toml::table table = parse_toml("x = 1\n[a]\nb = 2\n[[list]]\nv = 1\n[[list]]\nv = 2\n", "base.toml");
  table.insert("numbers", toml::array{1, 2, 3});
  set_value(table, path, text);
  return table;
}

TEST(SetValueTest, ReplacesAValueAnywhere) {
  EXPECT_EQ(with("x", "7")["x"].value<int>(), 7);
  EXPECT_EQ(with("a.b", "true")["a"]["b"].value<bool>(), true);
  EXPECT_EQ(with("list[1].v", "9")["list"][1]["v"].value<int>(), 9);
  EXPECT_EQ(with("numbers[2]", "9")["numbers"][2].value<int>(), 9);
  EXPECT_EQ(with("new.table.key", "1.5")["new"]["table"]["key"].value<double>(), 1.5);
}

TEST(SetValueTest, TakesTextsWithoutQuotes) {
  EXPECT_EQ(with("x", "25 deg")["x"].value<std::string>(), "25 deg");
  EXPECT_EQ(with("x", "ode")["x"].value<std::string>(), "ode");
  EXPECT_EQ(with("x", "\"ode\"")["x"].value<std::string>(), "ode");
  EXPECT_EQ(with("x", "a \"b\" \\c")["x"].value<std::string>(), "a \"b\" \\c");
  EXPECT_EQ(with("x", "1\ny = 2")["x"].value<std::string>(), "1 y = 2");
  EXPECT_EQ(with("x", "[1, 2]")["x"].as_array()->size(), 2u);
}

struct PathCase {
  const char* path;
  const char* message;
};
class WrongPathTest : public ::testing::TestWithParam<PathCase> {};

TEST_P(WrongPathTest, IsRefused) {
  try {
    with(GetParam().path, "1");
    FAIL() << GetParam().path;
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), std::string("--set ") + GetParam().path + GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Paths, WrongPathTest,
    ::testing::Values(PathCase{"", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"a..b", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"a.", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"[0]", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"list[", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"list[x]", ": is no path, such as plant.engine or waypoint[0].heading"},
                      PathCase{"list[2].v", "=1: there is no such place: list has 2 elements, from [0]"},
                      PathCase{"numbers[3]", "=1: there is no such place: numbers has 3 elements, from [0]"},
                      PathCase{"event[0].at",
                               "=1: there is no such place: the file has no [[event]]; write one there"},
                      PathCase{"x.y", "=1: there is no such place: x is a single value"},
                      PathCase{"x[0]", "=1: there is no such place: x is a single value"}));

}  // namespace
}  // namespace ironbird::scenarios
