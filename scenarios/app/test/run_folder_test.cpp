#include "scenarios/app/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {
namespace {

class RunFolderTest : public ::testing::Test {
 protected:
  ~RunFolderTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string refusal() const {
    try {
      const RunFolder second(path_);
    } catch (const UserError& error) {
      return error.what();
    }
    return "none";
  }

  // Tests of one program run at the same time: each needs a folder of its own.
  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("run_folder_" + std::to_string(getpid()));
  const std::filesystem::path path_ = folder_ / "out/mission";
};

TEST_F(RunFolderTest, IsRefusedToASecondRunUntilTheFirstHasEnded) {
  std::optional<RunFolder> first(path_);
  EXPECT_EQ(refusal(), path_.string() +
                           ": another run is writing its results here; wait for its end, or choose another "
                           "folder with --out");
  EXPECT_TRUE(std::filesystem::exists(path_)) << "the second has removed what the first made";
  first.reset();
  EXPECT_EQ(refusal(), "none");
}

TEST_F(RunFolderTest, IsHeldApartFromItsNeighbours) {
  const RunFolder first(path_);
  EXPECT_NO_THROW(RunFolder(folder_ / "out/other"));
  EXPECT_NO_THROW(RunFolder(folder_ / "out/mission/seed_1"));
}

TEST_F(RunFolderTest, GoesWhenNothingWasWritten) {
  { const RunFolder held(path_); }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(RunFolderTest, StaysAsItWasWithWhatIsInIt) {
  std::filesystem::create_directories(path_);
  std::ofstream(path_ / "verdict.json") << "{}";
  { const RunFolder held(path_); }
  EXPECT_TRUE(std::filesystem::exists(path_ / "verdict.json"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path_), {}), 1);
}

TEST_F(RunFolderTest, IsTakenByItsNameWhenAnotherHasRemovedIt) {
  // GIVEN a run that has begun in a folder that is gone
  std::optional<RunFolder> first(path_);
  std::filesystem::remove(path_);
  // WHEN a second begins THEN it has a folder of its own, which the first's end leaves alone
  const RunFolder second(path_);
  first.reset();
  EXPECT_TRUE(std::filesystem::exists(path_)) << "empty still, but not the first's";
  EXPECT_NE(refusal(), "none");
}

}  // namespace
}  // namespace ironbird::scenarios
