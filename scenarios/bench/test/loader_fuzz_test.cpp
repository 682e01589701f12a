// Scenarios of the library with random damage: each loads, or is refused in single lines that name a place.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "scenarios/bench/scenario_loader.hpp"

namespace ironbird::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr int kDamaged = 600;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Every scenario of the library, in an order of our own.
std::vector<fs::path> originals() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator("scenarios/library")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Damage {
 public:
  explicit Damage(std::uint32_t seed) : random_(seed) {}

  std::string to(std::string text) {
    const std::size_t times = 1 + below(3);
    for (std::size_t i = 0; i < times && !text.empty(); ++i) once(text);
    return text;
  }

  std::size_t below(std::size_t count) { return random_() % count; }

 private:
  void once(std::string& text) {
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        return;
      case 1:
        text.erase(at, 1 + below(30));
        return;
      case 2:
        text.insert(at, 1 + below(3), "[]{}=.,#\n\"'-09e_ "[below(17)]);
        return;
      case 3:
        return replace_value(text, at);
      case 4:
        text.insert(at, text.substr(below(text.size()), below(200)));
        return;
      default:
        text.resize(at);
    }
  }

  /// The value behind the next sign of equality becomes another one.
  void replace_value(std::string& text, std::size_t from) {
    static constexpr const char* kValues[] = {"nan",  "-inf",     "1e300",   "-1",
                                              "0",    "\"\"",     "[]",      "{}",
                                              "true", "\"x\"",    "[[]]",    "9223372036854775807",
                                              "0.1",  "\"1 kg\"", "\"\\n\"", "1e-320"};
    const std::size_t equals = text.find("= ", from);
    if (equals == std::string::npos) return;
    const std::size_t end = std::min(text.find('\n', equals), text.size());
    text.replace(equals + 2, end - equals - 2, kValues[below(std::size(kValues))]);
  }

  std::mt19937 random_;
};

class LoaderFuzzTest : public ::testing::Test {
 protected:
  // Tests of one program run at the same time: each needs a folder of its own.
  LoaderFuzzTest()
      : before_(fs::current_path()),
        folder_(fs::path(::testing::TempDir()) / ("loader_fuzz_" + std::to_string(getpid()))) {
    fs::current_path(IRONBIRD_SOURCE_DIR);
    fs::create_directories(folder_);
  }
  ~LoaderFuzzTest() override {
    fs::current_path(before_);
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  /// @return whether it was loaded
  bool expect_loaded_or_refused(const fs::path& file) const {
    static const std::regex kPlaced("[^:]+:[0-9]+:[0-9]+: [^\n]+");
    try {
      load_scenario(file, {}, modules_);
      return true;
    } catch (const ConfigError& error) {
      EXPECT_FALSE(error.findings().empty());
      for (const std::string& finding : error.findings())
        EXPECT_TRUE(std::regex_match(finding, kPlaced)) << finding << "\nof\n" << text_of(file);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\nof\n" << text_of(file);
    }
    return false;
  }

  autopilot::Modules modules_ = autopilot::standard_modules();
  fs::path before_;
  fs::path folder_;
};

TEST_F(LoaderFuzzTest, DamagedScenariosLoadOrAreRefusedWithAPlace) {
  const std::vector<fs::path> files = originals();
  ASSERT_FALSE(files.empty());
  Damage damage(1);
  const fs::path file = folder_ / "damaged.toml";
  int loaded = 0;
  for (int i = 0; i < kDamaged; ++i) {
    const std::string text = damage.to(text_of(files[damage.below(files.size())]));
    std::ofstream(file, std::ios::binary) << text;
    loaded += expect_loaded_or_refused(file) ? 1 : 0;
  }
  // Damage in a comment or in a number does no harm; much else does.
  EXPECT_GT(loaded, kDamaged / 50);
  EXPECT_LT(loaded, kDamaged / 2);
}

TEST_F(LoaderFuzzTest, DamagedVehiclesLoadOrAreRefusedWithAPlace) {
  const fs::path vehicle = folder_ / "vehicle";
  std::ofstream(folder_ / "mission.toml")
      << "vehicle = \"" << vehicle.string() << "\"\n[[waypoint]]\np_N = [0, 0, -5]\n";
  Damage damage(2);
  const std::vector<std::string> names = {"vehicle.toml", "sensors.toml", "fcu.toml", "autopilot.toml"};
  for (int i = 0; i < kDamaged; ++i) {
    fs::remove_all(vehicle);
    fs::copy("models/x650", vehicle);
    const fs::path file = vehicle / names[damage.below(names.size())];
    const std::string text = damage.to(text_of(file));
    std::ofstream(file, std::ios::binary) << text;
    expect_loaded_or_refused(folder_ / "mission.toml");
  }
}

}  // namespace
}  // namespace ironbird::scenarios
