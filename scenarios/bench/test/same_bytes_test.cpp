// The promise of a run: same scenario and seed, same bytes; another seed, others.

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "autopilot/modules.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/record/log.hpp"
#include "scenarios/record/mcap_reader.hpp"

namespace ironbird::scenarios {
namespace {

class SameBytesTest : public ::testing::Test {
 protected:
  SameBytesTest() { std::filesystem::create_directories(folder_); }
  ~SameBytesTest() override { std::filesystem::remove_all(folder_); }

  /// Flies the first 12 s, take-off included. @return the log's bytes
  std::string fly(std::uint64_t seed, int seconds_until_stop = 1000, const char* kind = "virtual",
                  const std::vector<std::pair<std::string, std::string>>& more = {}) {
    Overrides overrides{{{"duration", "12"}, {"fcu.kind", '"' + std::string(kind) + '"'}}, seed};
    overrides.settings.insert(overrides.settings.end(), more.begin(), more.end());
    const LoadedScenario loaded = load_scenario(scenario_, overrides, modules_);
    BenchOptions options;
    options.log_file = log_;
    options.on_progress = [&](const Progress& progress) { return progress.simulated < seconds_until_stop; };
    Bench bench(loaded, modules_, options);
    bench.fly();
    interrupted_ = bench.interrupted();
    std::ifstream stream(log_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  const std::filesystem::path scenario_ =
      std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/library/paper/three_waypoints.toml";
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("ironbird_same_bytes_" + std::to_string(getpid()));
  const std::filesystem::path log_ = folder_ / "flight.mcap";
  const autopilot::Modules modules_ = autopilot::standard_modules();
  bool interrupted_ = false;
};

TEST_F(SameBytesTest, TheSameSeedGivesTheSameBytes) {
  const std::string first = fly(3);
  EXPECT_GT(first.size(), 100000U);
  EXPECT_TRUE(first == fly(3));
}

TEST_F(SameBytesTest, AnotherSeedGivesOthers) {
  EXPECT_FALSE(fly(3) == fly(4));
}

TEST_F(SameBytesTest, AnInterruptedRunLeavesALogThatOpensAndIsTheBeginningOfTheWholeOne) {
  fly(3);
  const Log whole = Log::read(log_);
  fly(3, 6);
  EXPECT_TRUE(interrupted_);
  const Log part = Log::read(log_);
  const auto& times = part.topic("/truth/state")->time();
  const auto& all = whole.topic("/truth/state")->time();
  ASSERT_GT(times.size(), 400U);
  ASSERT_LT(times.size(), all.size());
  EXPECT_EQ(times.back(), all[times.size() - 1]);
}

TEST_F(SameBytesTest, OverAPseudoTerminalEveryMessageIsTheSame) {
  constexpr int kWholeRun = 1000;
  fly(3, kWholeRun, "virtual");
  const McapReader called(log_);
  fly(3, kWholeRun, "virtual_serial");
  const McapReader carried(log_);
  ASSERT_GT(called.messages().size(), 10000U);
  ASSERT_EQ(called.messages().size(), carried.messages().size());
  for (std::size_t k = 0; k < called.messages().size(); ++k) {
    const McapMessage& one = called.messages()[k];
    const McapMessage& other = carried.messages()[k];
    ASSERT_TRUE(one.channel == other.channel && one.log_time == other.log_time &&
                std::ranges::equal(one.data, other.data))
        << called.channels().at(one.channel).topic << " at " << one.log_time << " ns";
  }
}

TEST_F(SameBytesTest, TheSameSeedGivesTheSameFaultsOfTheLine) {
  constexpr int kWholeRun = 1000;
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"fcu.link_fault.outgoing", "{ drop = 0.1, corrupt = 0.001, reorder = 0.05, latency = \"3 ms\" }"},
      {"fcu.link_fault.incoming",
       "{ drop = 0.1, insert = 0.05, duplicate = 0.05, jitter = \"2 ms\", byte_rate = 92160, hang_up = 1e-4 "
       "}"}};
  const std::string first = fly(3, kWholeRun, "virtual_serial", faults);
  EXPECT_GT(first.size(), 100000U);
  EXPECT_TRUE(first == fly(3, kWholeRun, "virtual_serial", faults));
  EXPECT_FALSE(first == fly(4, kWholeRun, "virtual_serial", faults));
}

TEST_F(SameBytesTest, TheSameSeedGivesTheSameBytesWithAUnitOnTheDesk) {
  constexpr int kWholeRun = 1000;
  for (const char* motors : {"\"output_raw\"", "\"can\""}) {
    const std::string first = fly(3, kWholeRun, "hil", {{"fcu.motors", motors}});
    EXPECT_GT(first.size(), 100000U);
    EXPECT_TRUE(first == fly(3, kWholeRun, "hil", {{"fcu.motors", motors}})) << motors;
  }
}

}  // namespace
}  // namespace ironbird::scenarios
