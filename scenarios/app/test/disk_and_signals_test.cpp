// Disks that cannot be written to and runs that are interrupted, seen from outside.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/app/test/program.hpp"
#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {
namespace {

constexpr const char* kEightSeconds =
    "duration = \"8 s\"\n[[waypoint]]\np_N = [0, 0, -5]\n[[check]]\nname = \"c\"\nhappens = "
    "\"autopilot.flight.fcu.armed\"\n";
// More than the head of a log takes (about 60 kB of schemas), so that a run this far has records behind it,
// however slow the machine or the build.
constexpr const char* kBytesOfARunUnderWay = "1000000";

class DiskTest : public ::testing::Test {
 protected:
  /// Like a full disk: so many KiB for each file, and no signal when they are used up. The run is refused in
  /// one line and leaves nothing.
  Said fly_with_room_for(int room) const {
    const Said said = run_shell("trap '' XFSZ; ulimit -f " + std::to_string(room) + "; " + kProgram +
                                " run " + file_ + " --out " + out_.string());
    EXPECT_EQ(said.exit_code, 2) << said.text;
    EXPECT_EQ(said.lines(), 1) << said.text;
    EXPECT_NE(said.text.find("flight.mcap: writing failed"), std::string::npos) << said.text;
    EXPECT_FALSE(std::filesystem::exists(out_ / "short"));
    return said;
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_.write("short.toml", kEightSeconds);
  const std::filesystem::path out_ = folder_ / "out";
};

TEST_F(DiskTest, RefusesAnOutputFolderThatCannotBeMade) {
  const Said said = run_shell(kProgram + " run " + file_ + " --out /dev/null/out");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("/dev/null/out/short: cannot make the output folder"), std::string::npos)
      << said.text;
}

TEST_F(DiskTest, RefusesALogThatCannotBeMade) {
  std::filesystem::create_directories(out_ / "short/flight.mcap/in_its_place");
  const Said said = run_shell(kProgram + " run " + file_ + " --out " + out_.string());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("flight.mcap: cannot be made"), std::string::npos) << said.text;
}

TEST_F(DiskTest, SaysOnceThatTheDiskIsFullAndLeavesNoHalfALog) {
  const Said said = fly_with_room_for(400);
  EXPECT_NE(said.text.find("; raise the limit"), std::string::npos) << said.text;
}

TEST_F(DiskTest, SaysThatNotEvenTheFirstBytesOfALogHaveRoom) {
  fly_with_room_for(0);
}

TEST_F(DiskTest, SaysThatItsOutputCouldNotBeWritten) {
  for (const std::string& words :
       {std::string(" topics"), " run " + file_ + " --no-log --no-report --json --out " + out_.string()}) {
    const Said said = run_shell(kProgram + words + " >/dev/full");
    EXPECT_EQ(said.exit_code, 2) << words;
    EXPECT_NE(said.text.find("standard output: cannot be written: No space left on device"),
              std::string::npos)
        << said.text;
  }
}

TEST_F(DiskTest, LeavesNoHalfAReport) {
  const Said said =
      run_shell("trap '' XFSZ; ulimit -f 100; " + kProgram + " run " + file_ + " --no-log --junit " +
                (folder_ / "j.xml").string() + " --out " + out_.string());
  EXPECT_FALSE(std::filesystem::exists(out_ / "short/report.html")) << said.text;
}

TEST_F(DiskTest, LeavesNoSnapshotOfAnEarlierRun) {
  std::filesystem::create_directories(out_ / "short/snapshots");
  std::ofstream(out_ / "short/snapshots/old.png") << "x";
  std::ofstream(out_ / "short/snapshots/notes.txt") << "x";
  run_shell(kProgram + " run " + file_ + " --no-log --out " + out_.string());
  EXPECT_FALSE(std::filesystem::exists(out_ / "short/snapshots/old.png"));
  EXPECT_TRUE(std::filesystem::exists(out_ / "short/snapshots/notes.txt"));
}

TEST_F(DiskTest, SaysWhatHelpsWhenThereIsNoRoom) {
  const Said said =
      run_shell(kProgram + " run " + file_ + " --no-log --junit /dev/full --out " + out_.string());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(
      said.text,
      "/dev/full: cannot be written: No space left on device; make room there, or name another place on "
      "the command line\n");
}

TEST_F(DiskTest, AVerdictThatCannotBeWrittenIsAnErrorToo) {
  std::filesystem::create_directories(out_ / "short/verdict.json/in_its_place");
  const Said said = run_shell(kProgram + " run " + file_ + " --no-log --out " + out_.string());
  EXPECT_EQ(said.exit_code, 2) << said.text;
  EXPECT_EQ(said.lines(), 1) << said.text;
  EXPECT_NE(said.text.find("verdict.json: cannot be written"), std::string::npos) << said.text;
}

/// The shell's words that wait until a run of kEndless in the background has written something to `log_file`.
std::string until_under_way(const std::string& log_file) {
  return "for i in $(seq 1200); do [ $(stat -c %s " + log_file + " 2>/dev/null || echo 0) -gt " +
         kBytesOfARunUnderWay + " ] && break; sleep 0.05; done; ";
}

class HeldFolderTest : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string endless_ = folder_.write("mission.toml", kEndless);
  const std::string out_ = (folder_ / "out").string();
  const std::string log_file_ = out_ + "/mission/flight.mcap";
  const std::string run_ = kProgram + " run " + endless_ + " --out " + out_;
};

TEST_F(HeldFolderTest, RefusesASecondRunInTheFolderOfTheFirstAndLeavesThatAlone) {
  // GIVEN a run under way WHEN a second one is to write to the same folder
  const Said said = run_shell("env --default-signal=INT " + run_ + " >/dev/null 2>&1 & p=$!; " +
                              until_under_way(log_file_) + "i=$(stat -c %i " + log_file_ + "); " + run_ +
                              "; echo second $?; kill -INT $p; wait $p; echo first $?; [ $i = $(stat -c %i " +
                              log_file_ + ") ] && echo same file");
  // THEN it is refused in one line, and the first ends as it would have
  EXPECT_EQ(said.text, out_ +
                           "/mission: another run is writing its results here; wait for its end, or choose "
                           "another folder with --out\nsecond 2\nfirst 130\nsame file\n");
  EXPECT_FALSE(Log::read(log_file_).truncated());
}

TEST_F(HeldFolderTest, IsFreeAgainHoweverARunEnded) {
  const std::string brief = run_ + " --set duration=1";
  const Said said = run_shell(run_ + " >/dev/null 2>&1 & p=$!; " + until_under_way(log_file_) +
                              "kill -KILL $p; wait $p 2>/dev/null; " + brief);
  EXPECT_EQ(said.text.find("another run"), std::string::npos) << said.text;
  EXPECT_FALSE(Log::read(log_file_).truncated());
  EXPECT_TRUE(std::filesystem::exists(out_ + "/mission/verdict.json"));
}

class InterruptTest : public ::testing::TestWithParam<const char*> {};

TEST_P(InterruptTest, EndsTheRunWithALogThatOpens) {
  const TemporaryFolder folder;
  const std::string file = folder.write("endless.toml", kEndless);
  const std::string out = (folder / "out").string();
  const std::string log_file = out + "/endless/flight.mcap";
  // The shell would let its background jobs ignore Ctrl-C; env sets that right.
  const Said said =
      run_shell("env --default-signal=INT " + kProgram + " run " + file + " --out " + out + " & p=$!; " +
                until_under_way(log_file) + "kill -" + GetParam() + " $p; wait $p");
  EXPECT_EQ(said.exit_code, 130) << said.text;
  EXPECT_NE(said.text.find("interrupted"), std::string::npos) << said.text;
  const Log log = Log::read(log_file);
  ASSERT_NE(log.topic("/truth/state"), nullptr);
  EXPECT_GT(log.topic("/truth/state")->time().size(), 10U);
  EXPECT_TRUE(std::filesystem::exists(out + "/endless/verdict.json"));
  EXPECT_FALSE(std::filesystem::exists(out + "/endless/report.html"));
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptTest, ::testing::Values("INT", "TERM"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace ironbird::scenarios
