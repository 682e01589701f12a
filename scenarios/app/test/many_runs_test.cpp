// Several runs at once, seen from outside: whatever becomes of one, it is told, and nothing is left running.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kTwoSeconds =
    "duration = \"2 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n[[check]]\nname = \"c\"\nnone_of_events = "
    "[\"lifted_off\"]\n";
const std::string kFaulty = "'" FAULTY_PROGRAM "'";

std::string slurp(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class ManyRunsTest : public ::testing::Test {
 protected:
  /// Flies `good` beside `other`, two at once.
  Said fly(const std::string& program, const std::string& other, const std::string& options = "") {
    return run_shell(program + " run " + good_ + " " + other + " --jobs 2 --no-log --out " + out_ +
                     " --junit " + junit_ + " --json " + options + " > " + json_);
  }

  const TemporaryFolder folder_;
  const std::string good_ = folder_.write("good.toml", kTwoSeconds);
  const std::string out_ = (folder_ / "out").string();
  const std::string junit_ = (folder_ / "junit.xml").string();
  const std::string json_ = (folder_ / "out.json").string();
};

std::string with_estimator(const char* kind) {
  return std::string(kTwoSeconds) + "[autopilot.estimator]\nkind = \"" + kind + "\"\n";
}

struct FaultCase {
  const char* kind;
  int exit_code;
  std::string says;
};

class FaultyRunTest : public ManyRunsTest, public ::testing::WithParamInterface<FaultCase> {};

TEST_P(FaultyRunTest, IsToldEverywhereAndTheOtherRunIsNotHarmed) {
  const std::string bad = folder_.write("bad.toml", with_estimator(GetParam().kind));
  const Said said = fly(kFaulty, bad);
  EXPECT_EQ(said.exit_code, GetParam().exit_code) << said.text;
  EXPECT_THAT(said.text, HasSubstr("bad: " + GetParam().says));
  EXPECT_THAT(said.text, HasSubstr("good: pass"));

  const Json runs = Json::parse(slurp(json_));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].at("verdict"), "pass");
  EXPECT_EQ(runs[1].at("scenario"), "bad");
  EXPECT_EQ(runs[1].at("exit_code"), GetParam().exit_code);
  EXPECT_THAT(runs[1].at("error").get<std::string>(), HasSubstr(GetParam().says));

  const std::string junit = slurp(junit_);
  EXPECT_THAT(junit, HasSubstr("<testsuite name=\"good\" tests=\"1\" failures=\"0\" errors=\"0\""));
  EXPECT_THAT(junit, HasSubstr("<testsuite name=\"bad\" tests=\"1\" failures=\"0\" errors=\"1\""));
  EXPECT_THAT(junit, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultyRunTest,
    ::testing::Values(FaultCase{"throws", 4, "internal error: the sky is falling; please report it"},
                      FaultCase{"killed", 4,
                                "ended by signal 9 (Killed), without a verdict; most often the machine"},
                      FaultCase{"crashes", 4, "ended by signal 11 (Segmentation fault), without a verdict"},
                      FaultCase{"leaves", 4, "internal error: ended with exit code 0 before its verdict"}),
    [](const auto& tested) { return std::string(tested.param.kind); });

TEST_F(ManyRunsTest, AScenarioThatCannotBeLoadedDoesNotKeepTheOthersFromFlying) {
  const std::string bad = folder_.write("bad.toml", std::string("seed = -1\n") + kTwoSeconds);
  const Said said = fly(kProgram, bad);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_THAT(said.text, HasSubstr("bad.toml:1:"));
  const Json runs = Json::parse(slurp(json_));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_THAT(runs[0].at("error").get<std::string>(), HasSubstr("bad.toml:1:"));
  EXPECT_EQ(runs[1].at("verdict"), "pass");
  EXPECT_THAT(slurp(junit_), HasSubstr("<testsuite name=\"bad\" tests=\"1\" failures=\"0\" errors=\"1\""));
  EXPECT_THAT(slurp(junit_), HasSubstr("<testsuite name=\"good\" tests=\"1\" failures=\"0\" errors=\"0\""));
}

TEST_F(ManyRunsTest, AJunitFileThatCannotBeWrittenIsNoticedBeforeTheFlight) {
  const Said said =
      run_shell(kProgram + " run " + good_ + " --out " + out_ + " --junit /nonexistent/junit.xml");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(
      said.text,
      "/nonexistent/junit.xml: cannot be written: there is no folder /nonexistent; make it, or name another "
      "place on the command line\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(ManyRunsTest, TheJunitFileOfAProgramEndedByForceSaysSo) {
  const std::string bad = folder_.write("bad.toml", with_estimator("killed"));
  const Said said = run_shell(kFaulty + " run " + bad + " --no-log --out " + out_ + " --junit " + junit_);
  EXPECT_EQ(said.exit_code, 137);
  EXPECT_THAT(slurp(junit_), HasSubstr("<testsuite name=\"bad\" tests=\"1\" failures=\"0\" errors=\"1\""));
}

TEST_F(ManyRunsTest, AnErrorOfAnOnlyRunIsToldInOneLineToo) {
  const std::string bad = folder_.write("bad.toml", with_estimator("throws"));
  const Said said = run_shell(kFaulty + " run " + bad + " --no-log --out " + out_);
  EXPECT_EQ(said.exit_code, 4);
  EXPECT_EQ(
      said.text,
      "bad: internal error: the sky is falling; please report it, with this line, the scenario, and what "
      "`ironbird --version` says\n");
}

/// Starts two endless runs, sends `signal` to the parent alone once both are under way, and lists the
/// processes that are left a moment later.
std::string interrupt_parent(const std::string& program, const std::string& options,
                             const std::string& signal) {
  return "env --default-signal=INT " + program + " run " + options +
         " & p=$!; for i in $(seq 200); do [ $(cat /proc/$p/task/$p/children | wc -w) -eq 2 ] && break; "
         "sleep 0.05; done; sleep 0.5;"
         " children=$(cat /proc/$p/task/$p/children); kill -" +
         signal +
         " $p; wait $p; code=$?; sleep 0.2;"
         " for c in $children; do grep -qs '^State:.[^ZX]' /proc/$c/status && echo \"left behind\"; done; "
         "exit $code";
}

class ParentTest : public ManyRunsTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ParentTest, PassesAnInterruptOnToItsRuns) {
  const std::string endless = folder_.write("endless.toml", kEndless);
  const Said said = run_shell(interrupt_parent(
      kProgram, endless + " --seed 1:3 --jobs 2 --out " + out_ + " --junit " + junit_, GetParam()));
  EXPECT_EQ(said.exit_code, 130) << said.text;
  EXPECT_THAT(said.text, Not(HasSubstr("left behind")));
  EXPECT_THAT(slurp(junit_), HasSubstr("the run was interrupted"));
  EXPECT_THAT(slurp(junit_), HasSubstr("interrupted before it began"));
  // The runs ended in order: their logs are whole.
  EXPECT_TRUE(std::filesystem::exists(out_ + "/endless/seed_1/verdict.json"));
}

INSTANTIATE_TEST_SUITE_P(Signals, ParentTest, ::testing::Values("INT", "TERM"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_F(ManyRunsTest, NoRunOutlivesAParentThatIsKilled) {
  const std::string endless = folder_.write("endless.toml", kEndless);
  const Said said =
      run_shell(interrupt_parent(kProgram, endless + " --seed 1:2 --jobs 2 --no-log --out " + out_, "KILL"));
  EXPECT_EQ(said.exit_code, 137) << said.text;
  EXPECT_THAT(said.text, Not(HasSubstr("left behind")));
}

TEST_F(ManyRunsTest, ARunThatDoesNotEndWhenAskedIsEndedByForce) {
  const std::string bad = folder_.write("bad.toml", with_estimator("hangs"));
  const Said said =
      run_shell(interrupt_parent(kFaulty, bad + " --seed 1:2 --jobs 2 --no-log --out " + out_, "TERM"));
  EXPECT_THAT(said.text, HasSubstr("bad, seed 1: ended by signal 9"));
  EXPECT_THAT(said.text, Not(HasSubstr("left behind")));
}

TEST_F(ManyRunsTest, ShowOneLineOfProgressOnATerminal) {
  const Said said = run_on_terminal(
      kProgram + " run " + good_ + " --seed 1:4 --jobs 2 --no-log --set 'duration=\"60 s\"' --out " + out_,
      80);
  EXPECT_THAT(said.text, HasSubstr("\r\033[Kruns "));
  EXPECT_THAT(said.text, HasSubstr("of 4 done"));
  EXPECT_THAT(said.text, HasSubstr("[4/4] good, seed "));
}

TEST_F(ManyRunsTest, SummariesDoNotMixScenarios) {
  const std::string other = folder_.write("other.toml", kTwoSeconds);
  const Said said =
      run_shell(kProgram + " run " + good_ + " " + other + " --seed 1:2 --jobs 2 --no-log --out " + out_);
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_THAT(said.text, HasSubstr("\ngood: 2 of 2 runs pass\n"));
  EXPECT_THAT(said.text, HasSubstr("\nother: 2 of 2 runs pass\n"));
}

}  // namespace
}  // namespace ironbird::scenarios
