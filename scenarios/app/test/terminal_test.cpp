#include "scenarios/app/terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

const WorkDone kHalfway{"three_waypoints, seed 17", 60.0, 120.0, " 60.0 s flown,  480 x real time"};

/// Characters, not bytes.
std::size_t width_of(const std::string& line) {
  return static_cast<std::size_t>(std::count_if(
      line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

TEST(ProgressLineTest, SaysEverythingWhereThereIsRoom) {
  const std::string line = progress_line(kHalfway, 3.0, 0);
  for (const char* word :
       {"three_waypoints, seed 17", "████████████░░░░", "50 %", "60.0 s flown", "3 s left"}) {
    EXPECT_THAT(line, HasSubstr(word));
  }
}

TEST(ProgressLineTest, FitsAnyWidthAndKeepsThePercentage) {
  for (std::size_t columns = 5; columns < 140; ++columns) {
    const std::string line = progress_line(kHalfway, 3.0, columns);
    EXPECT_LE(width_of(line), columns) << line;
    EXPECT_THAT(line, HasSubstr("50 %"));
  }
}

}  // namespace
}  // namespace ironbird::scenarios
