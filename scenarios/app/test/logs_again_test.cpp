// Logs that are shown again, seen from outside: whole ones, ones that were cut short, ones that are none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "scenarios/app/test/program.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// One short flight, flown once for all tests, and logs that are cut out of its log.
class LogsAgainTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const std::string file =
        folder_->write("flight.toml",
                       "duration = \"7 s\"\nvehicle = \"models/x650\"\n[[waypoint]]\np_N = [0, 0, -5]\n"
                       "[[check]]\nname = \"flies\"\nhappens = \"autopilot.flight.fcu.armed\"\n");
    const Said said = run_shell(kProgram + " run " + file + " --out " + folder_->text());
    ASSERT_EQ(said.exit_code, 0) << said.text;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string path(const std::string& name) { return (*folder_ / name).string(); }
  static std::string bytes(const std::string& name) {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  /// A copy of the log and its verdict in a folder of their own; of the log only the first part.
  static std::string cut(const std::string& name, double share) {
    std::filesystem::create_directories(path(name));
    std::filesystem::copy_file(path("flight/verdict.json"), path(name + "/verdict.json"));
    const std::string whole = bytes("flight/flight.mcap");
    std::ofstream(path(name + "/flight.mcap"), std::ios::binary)
        << whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
    return path(name + "/flight.mcap");
  }
  static Said show(const std::string& verb, const std::string& log, const std::string& out) {
    return run_shell(kProgram + " " + verb + " " + log + " --out " + out);
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* LogsAgainTest::folder_ = nullptr;

TEST_F(LogsAgainTest, SaysNothingOfAWholeLog) {
  const Said said = show("report", path("flight/flight.mcap"), path("whole.html"));
  EXPECT_EQ(said.text, path("whole.html") + "\n");
  EXPECT_THAT(bytes("whole.html"), Not(HasSubstr("class=\"warning\"")));
}

TEST_F(LogsAgainTest, TellsWhatACutLogHasLost) {
  const std::string log = cut("half", 0.5);
  const Said said = show("report", log, path("half.html"));
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_THAT(said.text, StartsWith(log + ": warning: the log was cut short at "));
  EXPECT_THAT(said.text, HasSubstr(" s of 7.003 s: the last "));
  EXPECT_THAT(bytes("half.html"), HasSubstr("<p class=\"warning\">the log was cut short at "));
}

TEST_F(LogsAgainTest, TellsItOfAFilmAndOfPicturesToo) {
  const std::string log = cut("pictured", 0.5);
  for (const char* verb : {"video --preview", "snapshot"}) {
    const Said said = show(verb, log, path("pictured/film.y4m"));
    EXPECT_EQ(said.exit_code, 0) << said.text;
    EXPECT_THAT(said.text, HasSubstr(log + ": warning: the log was cut short at ")) << verb;
    EXPECT_THAT(said.text, HasSubstr("what came after is lost\n")) << verb;
    std::filesystem::remove(path("pictured/film.y4m"));
  }
}

TEST_F(LogsAgainTest, RefusesALogOfWhichNothingIsLeft) {
  for (const auto& [name, share] : {std::pair("empty", 0.0), std::pair("headed", 0.0002)}) {
    const std::string log = cut(name, share);
    for (const char* verb : {"report", "video", "snapshot"}) {
      const Said said = show(verb, log, path(std::string(name) + ".y4m"));
      EXPECT_EQ(said.exit_code, 2) << verb;
      EXPECT_EQ(said.text,
                log +
                    ": nothing can be shown of it: it holds no message; name the log of a run that "
                    "flew\n")
          << verb;
      EXPECT_FALSE(std::filesystem::exists(path(std::string(name) + ".y4m")));
    }
  }
}

TEST_F(LogsAgainTest, MakesNoReportWhenOneOfItsLogsIsEmpty) {
  const std::string log = cut("hollow", 0.0);
  const Said said = show("report", path("flight/flight.mcap") + " " + log, path("both.html"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_FALSE(std::filesystem::exists(path("both.html")));
}

TEST_F(LogsAgainTest, ShowsNoVerdictOfAnotherRun) {
  const std::string log = cut("strange", 1.0);
  std::string verdict = bytes("strange/verdict.json");
  const std::size_t at = verdict.find("\"digest\": \"") + 11;
  verdict[at] = verdict[at] == 'a' ? 'b' : 'a';
  std::ofstream(path("strange/verdict.json")) << verdict;
  const Said said = show("report", log, path("strange.html"));
  EXPECT_THAT(said.text,
              HasSubstr(": warning: the verdict.json beside the log is of another run and is not shown\n"));
  EXPECT_THAT(bytes("strange.html"), HasSubstr("<div class=\"stamp\">not judged</div>"));
}

TEST_F(LogsAgainTest, SaysThatThereAreNoSnapshotsToTake) {
  EXPECT_THAT(show("snapshot", path("flight/flight.mcap"), path("none")).text,
              HasSubstr("no picture was taken: the scenario has no [[snapshot]]\n"));
}

struct PlaceCase {
  const char* name;
  const char* words;
  const char* says;
};

class PlaceTest : public LogsAgainTest, public ::testing::WithParamInterface<PlaceCase> {};

TEST_P(PlaceTest, IsRefusedInOneLineThatNamesIt) {
  std::filesystem::create_directories(path("folder.mp4"));
  const Said said = run_shell("L=" + path("flight/flight.mcap") + " D=" + folder_->text() + "; " + kProgram +
                              " " + GetParam().words);
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_THAT(said.text, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, PlaceTest,
    ::testing::Values(
        PlaceCase{"FilmInAFolderThatTakesNoFile", "video $L --out /proc/x.mp4",
                  "/proc/x.mp4: cannot be written: the folder /proc takes no file"},
        PlaceCase{"FilmInNoFolder", "video $L --out /nowhere/x.mp4", "there is no folder /nowhere; make it"},
        PlaceCase{"PlainFilmInNoFolder", "video $L --out /nowhere/x.y4m",
                  "there is no folder /nowhere; make it"},
        PlaceCase{"FilmInPlaceOfAFolder", "video $L --out $D/folder.mp4",
                  "it is a folder; name a file in it"},
        PlaceCase{"FilmWithoutAName", "video $L --out $D", "it is a folder; name a file in it"},
        PlaceCase{"FilmOfAnotherKind", "video $L --out $D/x.avi", "a film is .mp4 or .y4m"},
        PlaceCase{"ReportInPlaceOfAFolder", "report $L --out $D", "it is a folder; name a file in it"},
        PlaceCase{"ReportInPlaceOfItsLog", "report $L --out $L", "itself; name another file"},
        PlaceCase{"ReportInPlaceOfItsVerdict", "report $L --out $D/flight/verdict.json",
                  "verdict.json itself; name another file"},
        PlaceCase{"ReportInNoFolder", "report $L --out /nowhere/r.html",
                  "there is no folder /nowhere; make it"},
        PlaceCase{"FolderForALog", "report $D", "it is a folder; name the log in it"},
        PlaceCase{"NoLog", "video $D/none.mcap", "none.mcap: cannot be opened: there is no such file"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(LogsAgainTest, ReplaysARunBesideItAndNeverOverIt) {
  const std::string flown = bytes("flight/flight.mcap");
  const Said said =
      run_shell(kProgram + " replay " + path("flight/flight.mcap") + " --out " + folder_->text());
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_THAT(said.text, HasSubstr("commands are the same"));
  EXPECT_TRUE(std::filesystem::exists(path("flight_replayed/report.html")));
  // A replay may take the place of a replay, and of nothing else.
  EXPECT_EQ(
      run_shell(kProgram + " replay " + path("flight/flight.mcap") + " --out " + folder_->text()).exit_code,
      0);
  std::filesystem::create_directories(path("kept"));
  std::filesystem::copy_file(path("flight/flight.mcap"), path("kept/flight.mcap"));
  std::filesystem::create_directories(path("out/kept_replayed"));
  std::filesystem::copy_file(path("flight/flight.mcap"), path("out/kept_replayed/flight.mcap"));
  const Said refused = run_shell(kProgram + " replay " + path("kept/flight.mcap") + " --out " + path("out"));
  EXPECT_EQ(refused.exit_code, 2) << refused.text;
  EXPECT_THAT(refused.text, HasSubstr("is no replay's and would be lost; name another folder with --out"));
  EXPECT_EQ(bytes("flight/flight.mcap"), flown);
  EXPECT_EQ(bytes("out/kept_replayed/flight.mcap"), flown);
}

}  // namespace
}  // namespace ironbird::scenarios
