#include "scenarios/config/write_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

class WritableTest : public ::testing::Test {
 protected:
  WritableTest() { std::filesystem::create_directories(folder_ / "inside"); }
  ~WritableTest() override {
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder_);
  }

  static std::string refusal(const std::filesystem::path& file) {
    try {
      check_writable(file);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("writable_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(WritableTest, TakesANewFileAndLeavesNothing) {
  EXPECT_EQ(refusal(folder_ / "new.html"), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "inside"));
  EXPECT_EQ(refusal(folder_ / "inside/new.html"), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "inside"));
}

TEST_F(WritableTest, LeavesWhatIsThereAlone) {
  std::ofstream(folder_ / "old.html") << "old";
  EXPECT_EQ(refusal(folder_ / "old.html"), "");
  EXPECT_EQ(std::filesystem::file_size(folder_ / "old.html"), 3U);
}

TEST_F(WritableTest, RefusesAFolder) {
  EXPECT_THAT(refusal(folder_ / "inside"),
              EndsWith("inside: cannot be written: it is a folder; name a file in it"));
}

TEST_F(WritableTest, NamesTheFolderThatIsNotThere) {
  EXPECT_THAT(refusal("/nowhere/report.html"),
              HasSubstr("/nowhere/report.html: cannot be written: there is no folder /nowhere; make it"));
}

TEST_F(WritableTest, NamesTheFolderThatTakesNoFile) {
  // Not even for root.
  EXPECT_THAT(refusal("/proc/report.html"), HasSubstr("the folder /proc takes no file: "));
  if (geteuid() == 0) return;
  std::filesystem::permissions(folder_,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  EXPECT_THAT(refusal(folder_ / "report.html"),
              HasSubstr("takes no file: Permission denied; name another place on the command line"));
}

TEST_F(WritableTest, LeavesADeviceToItself) {
  EXPECT_EQ(refusal("/dev/null"), "");
}

}  // namespace
}  // namespace ironbird::scenarios
