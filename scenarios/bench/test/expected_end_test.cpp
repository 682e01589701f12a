#include "scenarios/bench/expected_end.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"

namespace ironbird::scenarios {
namespace {

double expected_end_of(const std::filesystem::path& file, Overrides overrides = {}) {
  return expected_end(load_scenario(file, overrides, autopilot::standard_modules()));
}

struct LibraryCase {
  const char* file;
  double end;  // s, as flown
};

std::ostream& operator<<(std::ostream& stream, const LibraryCase& tested) {
  return stream << tested.file;
}

class ExpectedEndTest : public ::testing::TestWithParam<LibraryCase> {};

TEST_P(ExpectedEndTest, IsNearTheEndThatWasFlown) {
  // A bar that is a tenth of the way off is still one to wait by.
  const double expected =
      expected_end_of(std::string(IRONBIRD_SOURCE_DIR "/scenarios/library/") + GetParam().file);
  EXPECT_NEAR(expected, GetParam().end, 0.1 * GetParam().end);
}

INSTANTIATE_TEST_SUITE_P(Library, ExpectedEndTest,
                         ::testing::Values(LibraryCase{"paper/three_waypoints.toml", 118.9},
                                           LibraryCase{"missions/geodetic.toml", 64.5},
                                           LibraryCase{"missions/take_off_and_land.toml", 25.1},
                                           LibraryCase{"faults/estimator_swap.toml", 53.3},
                                           LibraryCase{"faults/low_battery.toml", 31.5},
                                           LibraryCase{"entry_points/entry_00_position_heading.toml", 39.5}),
                         [](const auto& tested) {
                           return std::filesystem::path(tested.param.file).stem().string();
                         });

TEST(ExpectedEndTest, IsTheDurationWhenNothingEndsTheRunEarlier) {
  const std::filesystem::path file = IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml";
  EXPECT_EQ(expected_end_of(file, {{{"end_after", ""}}, {}}), 150.0);
  EXPECT_EQ(expected_end_of(file, {{{"duration", "30 s"}}, {}}), 30.0);
  EXPECT_EQ(expected_end_of(file, {{{"end_after", "crashed"}}, {}}), 150.0);
}

TEST(ExpectedEndTest, IsWhatARunTellsWhoeverWaits) {
  const auto modules = autopilot::standard_modules();
  const LoadedScenario loaded =
      load_scenario(IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml", {}, modules);
  std::vector<double> told;
  BenchOptions options;
  options.on_progress = [&](const Progress& progress) {
    told.push_back(progress.expected_end);
    return false;
  };
  Bench(loaded, modules, options).fly();
  EXPECT_EQ(told, std::vector<double>{expected_end(loaded)});
}

TEST(ExpectedEndTest, IsShownAsNearWhileARunTakesLonger) {
  EXPECT_EQ(shown_end(100.0, 50.0, 300.0), 100.0);
  EXPECT_DOUBLE_EQ(shown_end(100.0, 190.0, 300.0), 200.0);
  EXPECT_EQ(shown_end(100.0, 299.0, 300.0), 300.0);
}

}  // namespace
}  // namespace ironbird::scenarios
