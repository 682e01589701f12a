#include "scenarios/app/failure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

TEST(FailureTest, LeavesWhatTheUserCanMendInItsOwnWords) {
  const Failure wrong = failure_of(ConfigError("a.toml:1:2: mass = -1: must be > 0"));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.text, "a.toml:1:2: mass = -1: must be > 0");
  EXPECT_EQ(failure_of(UserError("x: cannot be written")).exit_code, 2);
  EXPECT_EQ(failure_of(std::invalid_argument("x = 0, must be > 0")).exit_code, 2);
  EXPECT_EQ(failure_of(std::filesystem::filesystem_error("x", std::error_code())).exit_code, 2);
}

TEST(FailureTest, NamesThePlaceAndTheRemedyOfAFolderThatCannotBeMade) {
  const std::filesystem::filesystem_error error("cannot create directories", "ro/r",
                                                std::make_error_code(std::errc::read_only_file_system));
  EXPECT_EQ(failure_of(error).text, "ro/r: Read-only file system; name another place on the command line");
}

TEST(FailureTest, AsksForAReportOfEverythingElse) {
  for (const Failure& defect : {failure_of(std::runtime_error("odd")), failure_of(std::logic_error("odd"))}) {
    EXPECT_EQ(defect.exit_code, 4);
    EXPECT_THAT(defect.text, HasSubstr("internal error: odd; please report it"));
    EXPECT_THAT(defect.text, HasSubstr("ironbird --version"));
  }
}

TEST(FailureTest, KnowsTheRemedyForMemoryThatRunsOut) {
  EXPECT_THAT(failure_of(std::bad_alloc()).text, HasSubstr("--jobs"));
  EXPECT_THAT(failure_of_signal(SIGKILL).text, HasSubstr("--jobs"));
}

TEST(FailureTest, TellsAnInterruptFromACrash) {
  EXPECT_EQ(failure_of_signal(SIGTERM).exit_code, 130);
  EXPECT_EQ(failure_of_signal(SIGSEGV).exit_code, 4);
  EXPECT_THAT(failure_of_signal(SIGSEGV).text, HasSubstr("please report it"));
}

}  // namespace
}  // namespace ironbird::scenarios
