#include "scenarios/config/file_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

class FileSearchTest : public ::testing::Test {
 protected:
  FileSearchTest() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::path(::testing::TempDir()) / (std::string("file_search_") + test->name());
    fs::remove_all(root_);
    fs::create_directories(root_ / "mine/missions");
  }
  ~FileSearchTest() override {
    fs::current_path(started_in_);
    fs::remove_all(root_);
  }

  fs::path file(const std::string& name) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << "x = 1\n";
    return root_ / name;
  }

  fs::path root_;
  fs::path started_in_ = fs::current_path();
};

TEST_F(FileSearchTest, GoesFromTheFileUpwardsThenToTheTreeThenToTheWorkingFolder) {
  fs::create_directories(root_ / "elsewhere");
  fs::current_path(root_ / "elsewhere");
  const std::vector<fs::path> folders = search_folders(root_ / "mine/missions/a.toml");
  const auto at = [&](const fs::path& folder) {
    return std::find(folders.begin(), folders.end(), folder) - folders.begin();
  };
  EXPECT_EQ(at(root_ / "mine/missions"), 0);
  EXPECT_EQ(at(root_ / "mine"), 1);
  EXPECT_LT(at("/"), at(IRONBIRD_SOURCE_DIR));
  EXPECT_LT(at(IRONBIRD_SOURCE_DIR), at(root_ / "elsewhere"));
  EXPECT_LT(at(root_ / "elsewhere"), static_cast<long>(folders.size()));
}

TEST_F(FileSearchTest, FindsTheTreesModelsForAFileAnywhere) {
  const std::vector<fs::path> folders = search_folders(root_ / "mine/a.toml");
  EXPECT_EQ(find_named("models/x650", folders, "vehicle.toml"),
            fs::path(IRONBIRD_SOURCE_DIR) / "models/x650");
}

TEST_F(FileSearchTest, PrefersWhatLiesBesideTheFile) {
  const fs::path own = file("mine/models/x650/vehicle.toml").parent_path();
  EXPECT_EQ(find_named("models/x650", search_folders(root_ / "mine/a.toml"), "vehicle.toml"), own);
  EXPECT_EQ(find_named("../models/x650", search_folders(root_ / "mine/missions/a.toml"), "vehicle.toml"),
            own);
}

TEST_F(FileSearchTest, PassesByAFolderWithoutTheFileThatMakesItOne) {
  file("mine/models/x650/README.md");
  EXPECT_EQ(find_named("models/x650", search_folders(root_ / "mine/a.toml"), "vehicle.toml"),
            fs::path(IRONBIRD_SOURCE_DIR) / "models/x650");
}

TEST_F(FileSearchTest, FindsNothingByTheEmptyNameOrOneThatIsNowhere) {
  const std::vector<fs::path> folders = search_folders(root_ / "mine/a.toml");
  EXPECT_TRUE(find_named("", folders).empty());
  EXPECT_TRUE(find_named("models/of_nobody", folders).empty());
}

TEST_F(FileSearchTest, WritesPathsFromTheWorkingFolderWhenTheyLieBelowIt) {
  fs::current_path(root_);
  EXPECT_EQ(readable(fs::current_path() / "mine/a.toml"), "mine/a.toml");
  EXPECT_EQ(readable("/somewhere/a.toml"), "/somewhere/a.toml");
}

}  // namespace
}  // namespace ironbird::scenarios
