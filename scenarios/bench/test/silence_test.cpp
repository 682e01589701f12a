// What the bench does when the FCU says nothing, and what it refuses to fly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {
namespace {

using ::testing::HasSubstr;

class SilenceTest : public ::testing::Test {
 protected:
  SilenceTest() { std::filesystem::create_directories(folder_); }
  ~SilenceTest() override { std::filesystem::remove_all(folder_); }

  LoadedScenario load(const std::string& text, const Overrides& overrides = {}) {
    const std::filesystem::path file = folder_ / "scenario.toml";
    std::ofstream(file) << text;
    return load_scenario(file, overrides, modules_);
  }

  std::string finding(const std::string& text, const Overrides& overrides = {}) {
    try {
      load(text, overrides);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no finding";
  }

  const std::string quiet_ = R"(
duration = "4 s"
[[waypoint]]
p_N = [5, 0, -5]
[[event]]
at = "1 s"
fault = "imu_dropout"
lasts = "2 s"
)";
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("ironbird_silence_" + std::to_string(getpid()));
  const autopilot::Modules modules_ = autopilot::standard_modules();
};

TEST_F(SilenceTest, RecordsTheTruthAtItsPeriodWhileTheImuIsSilent) {
  const LoadedScenario loaded = load(quiet_);
  BenchOptions options;
  options.log_file = folder_ / "flight.mcap";
  Bench bench(loaded, modules_, options);
  bench.fly();
  const Log log = Log::read(options.log_file);
  const auto& times = log.topic("/truth/state")->time();
  double longest = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) longest = std::max(longest, times[i] - times[i - 1]);
  EXPECT_LT(longest, 0.0101) << "s; the period is 10 ms";
  EXPECT_LT(times.front(), 0.0101);
  EXPECT_GT(times.back(), 3.98);
  const auto& frames = log.topic("/autopilot/sensors")->time();
  EXPECT_EQ(std::count_if(frames.begin(), frames.end(), [](double t) { return t > 1.1 && t < 2.9; }), 0)
      << "there were no frames, and none is made up";
}

TEST_F(SilenceTest, RefusesAnEstimatorThatNothingFeeds) {
  const Overrides on_poses{{{"autopilot.estimator.kind", "external_pose"}}, {}};
  EXPECT_THAT(finding(quiet_, on_poses), HasSubstr("autopilot.estimator.kind = \"external_pose\""));
  const std::string swap =
      quiet_ + "[[event]]\nat = \"3 s\"\nswap = \"estimator\"\nkind = \"external_pose\"\n";
  EXPECT_THAT(finding(swap), HasSubstr("event[1].kind = \"external_pose\": flies on poses from outside"));
  EXPECT_EQ(finding(quiet_), "no finding");
}

}  // namespace
}  // namespace ironbird::scenarios
