#include "scenarios/config/text_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "scenarios/config/config_error.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

class TextFileTest : public ::testing::Test {
 protected:
  TextFileTest()
      : folder_(std::filesystem::path(::testing::TempDir()) / ("text_file_" + std::to_string(getpid()))) {
    // Tests of one program run at the same time: each needs a folder of its own.
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "mission.toml") << "x = 1\n";
  }
  ~TextFileTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string refusal(const std::filesystem::path& file) const {
    try {
      read_config_text(file, "asked: ");
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(TextFileTest, ReadsAFileWhole) {
  EXPECT_EQ(read_config_text(folder_ / "mission.toml", ""), "x = 1\n");
}

TEST_F(TextFileTest, ReadsAnEmptyFile) {
  std::ofstream(folder_ / "empty.toml").flush();
  EXPECT_EQ(read_config_text(folder_ / "empty.toml", ""), "");
}

TEST_F(TextFileTest, NamesTheFileThatWasMeant) {
  EXPECT_EQ(refusal(folder_ / "misson.toml"),
            "asked: " + (folder_ / "misson.toml").string() +
                ": cannot be opened: there is no such file; did you mean '" +
                (folder_ / "mission.toml").string() + "'?");
  EXPECT_THAT(refusal("/nowhere/at_all.toml"), ::testing::EndsWith("there is no such file"));
}

TEST_F(TextFileTest, NamesTheScenarioOfTheLibraryWhenNoneBesideItIsNear) {
  for (const std::string name : {"three_waypoint.toml", "three_waypoints", "papre/three_waypoints.toml"}) {
    EXPECT_THAT(refusal(folder_ / name),
                ::testing::EndsWith("scenarios/library/paper/three_waypoints.toml'?"))
        << name;
  }
}

TEST_F(TextFileTest, RefusesWhatIsNoFile) {
  EXPECT_THAT(refusal(folder_), HasSubstr("is a folder, must be a TOML file"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("is no regular file"));
  EXPECT_THAT(refusal(folder_ / std::string(300, 'x')), HasSubstr("cannot be opened"));
  EXPECT_THAT(refusal(folder_ / "mission.toml" / "inside.toml"), HasSubstr("cannot be opened"));
}

TEST_F(TextFileTest, RefusesAHugeFileWithoutReadingIt) {
  std::ofstream(folder_ / "huge.toml").flush();
  std::filesystem::resize_file(folder_ / "huge.toml", 1U << 30U);  // takes no room on the disk
  EXPECT_THAT(refusal(folder_ / "huge.toml"), HasSubstr("has 1073741824 bytes, a configuration has at most"));
}

}  // namespace
}  // namespace ironbird::scenarios
