// What the program says of itself, and to words it does not know. Terminals of all sorts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(CommandLineTest, ShowsHowToBeginWhenNothingIsAsked) {
  const Said said = run_shell(kProgram);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_THAT(said.text, HasSubstr("Start with: ironbird run "));
}

TEST(CommandLineTest, SaysItsVersion) {
  const Said said = run_shell(kProgram + " --version 2>/dev/null");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_TRUE(said.text.starts_with("ironbird 0.")) << said.text;
}

struct WordCase {
  const char* name;
  const char* words;
  const char* says;
};

class WrongWordTest : public ::testing::TestWithParam<WordCase> {};

TEST_P(WrongWordTest, GetsTheNearestRightOneInOneLine) {
  const Said said = run_shell(kProgram + " " + GetParam().words);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_THAT(said.text, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Words, WrongWordTest,
    ::testing::Values(
        WordCase{"Verb", "rnu x.toml", "rnu: there is no such verb; did you mean run?"},
        WordCase{"VerbUnlikeAny", "wxyzwxyz", "run, check, replay, report, video, snapshot, fcu, topics"},
        WordCase{"Option", "run x.toml --jbos 2", "--jbos: run does not take this; did you mean --jobs?"},
        WordCase{"OptionUnlikeAny", "check x.toml --zzzzzzzzzz",
                 "--zzzzzzzzzz: check does not take this; see ironbird check --help"},
        WordCase{"OptionWithValue", "run x.toml --ot=y", "did you mean --out?"},
        WordCase{"NoScenario", "run", "scenarios is required; see ironbird run --help"},
        WordCase{"NoNumber", "run x.toml --jobs many", "--jobs"}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// A folder that looks like the root of the tree, to fly in without leaving anything in the real one.
class ExamplesTest : public ::testing::TestWithParam<const char*> {
 protected:
  /// The lines of the verb's help that are commands.
  static std::vector<std::string> examples() {
    std::istringstream help(run_shell(kProgram + " " + GetParam() + " --help").text);
    std::vector<std::string> found;
    for (std::string line; std::getline(help, line);) {
      if (line.starts_with("  ironbird ")) found.push_back(line.substr(2));
    }
    return found;
  }

  Said run_in_tree(const std::string& command) const {
    return run_shell("for d in models scenarios; do ln -sfn \"$PWD/$d\" " + folder_.text() +
                     "/$d; done; cd " + folder_.text() + "; ironbird() { " + kProgram + " \"$@\"; }; " +
                     command);
  }

  const TemporaryFolder folder_;
};

TEST_P(ExamplesTest, OfTheHelpWork) {
  const std::string mission = "ironbird run scenarios/library/paper/three_waypoints";
  const std::string shortly = " --no-report --set duration=\"0.2 s\"";
  const std::vector<std::string> commands = examples();
  ASSERT_FALSE(commands.empty());
  for (const std::string& command : commands) {
    const bool flies = std::string(GetParam()) == "run";
    if (!flies) run_in_tree(mission + ".toml " + mission.substr(13) + "_ode.toml" + shortly);
    const Said said = run_in_tree(command + (flies ? shortly : ""));
    // So short a flight proves nothing: its verdict may be what it likes.
    const bool understood = flies ? said.exit_code == 1 || said.exit_code == 5 : said.exit_code == 0;
    EXPECT_TRUE(understood) << command << " ended with " << said.exit_code << "\n" << said.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Verbs, ExamplesTest,
                         ::testing::Values("run", "check", "report", "video", "snapshot", "topics"),
                         [](const auto& tested) { return std::string(tested.param); });

constexpr const char* kThreeSeconds =
    "duration = \"3 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n[[check]]\nname = \"c\"\nnone_of_events = "
    "[\"lifted_off\"]\n";

class TerminalTest : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string fly_ =
      kProgram + " run " + folder_.write("short.toml", kThreeSeconds) + " --no-log --out " + folder_.text();
};

TEST_F(TerminalTest, APersonSeesABarAndColours) {
  const Said said = run_on_terminal(fly_, 200);
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_THAT(said.text, HasSubstr("░"));
  EXPECT_THAT(said.text, HasSubstr("\033[1;32mpass"));
}

TEST_F(TerminalTest, NoColorIsObeyed) {
  EXPECT_THAT(run_on_terminal("NO_COLOR=1 " + fly_, 200).text, Not(HasSubstr("\033[1;")));
}

TEST_F(TerminalTest, ABuildServerGetsPlainLinesEvenOnATerminal) {
  const Said said = run_on_terminal("CI=true NO_COLOR=1 " + fly_, 200);
  EXPECT_THAT(said.text, Not(HasSubstr("\033")));
  EXPECT_THAT(said.text, HasSubstr("short: pass: c:"));
}

TEST_F(TerminalTest, AFileGetsPlainLines) {
  const Said said = run_shell("unset CI; export TERM=xterm; " + fly_);
  EXPECT_THAT(said.text, Not(HasSubstr("\033")));
  EXPECT_THAT(said.text, HasSubstr("short: pass\n"));
}

TEST_F(TerminalTest, NothingWrapsOnANarrowOne) {
  std::istringstream lines(run_on_terminal("NO_COLOR=1 " + fly_, 40).text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find_last_not_of('\r') + 1);
    const std::size_t redrawn = line.rfind("\r\033[K");
    if (redrawn != std::string::npos) line = line.substr(redrawn + 4);
    EXPECT_LE(line.size(), 40U) << line;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
