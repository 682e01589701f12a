#include "scenarios/bench/scenario_loader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

#include "autopilot/modules.hpp"
#include "scenarios/config/include.hpp"

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

// It is the log's word on what was flown.
TEST(ScenarioLoaderTest, WritesAConfigurationThatCanBeReadBackWhateverTheFoldersName) {
  const fs::path folder = fs::path(testing::TempDir()) / "it's \"mine\"";
  fs::remove_all(folder);
  fs::copy(IRONBIRD_SOURCE_DIR "/models/x650", folder, fs::copy_options::recursive);
  const LoadedScenario loaded =
      load_scenario(IRONBIRD_SOURCE_DIR "/scenarios/library/paper/three_waypoints.toml",
                    {.settings = {{"vehicle", folder.string()}}, .seed = {}}, autopilot::standard_modules());
  const toml::table config = parse_toml(loaded.effective_config, "config");
  EXPECT_EQ(config["vehicle_folder"].value<std::string>(), folder.string());
  EXPECT_EQ(config["end_after"].value<std::string>(), "landed");
}

}  // namespace
}  // namespace ironbird::scenarios
