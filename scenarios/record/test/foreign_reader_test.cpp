#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "autopilot/signals.hpp"
#include "scenarios/record/recorder.hpp"
#include "simulator/types/truth.hpp"

// Does somebody else's reader find in our logs what we put there?

namespace ironbird::scenarios {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr int kTicks = 400;
const std::filesystem::path kReaderFolder =
    std::filesystem::path(IRONBIRD_SOURCE_DIR) / "scenarios/record/test/foreign";

/// Signals that use every kind of member: absent and present parts, a variant, a sequence, enumerations.
autopilot::Signals signals_at(int tick) {
  autopilot::Signals signals;
  signals.sensors.imu.stamp = milliseconds(tick);
  signals.sensors.imu.f_B = {0.5, -0.25, -9.81};
  if (tick % 4 == 0)
    signals.sensors.mag = autopilot::MagSample{milliseconds(tick), {0.125, 1.0 * tick, -1.0}};
  signals.estimate.q_NB = autopilot::Quaternion(0.5, -0.5, 0.5, 0.5);
  signals.estimate.health = autopilot::Health::kDegraded;
  signals.route.waypoints.resize(2);
  signals.route.waypoints[1].kind = autopilot::WaypointKind::kLand;
  signals.route.waypoints[1].p_N = {1.0, 2.0, -3.0};
  if (tick % 2 == 1) signals.setpoint = autopilot::RateThrottle{{1.0, 2.0, 3.0}, 0.25};
  return signals;
}

void write_log(const std::filesystem::path& file, const McapOptions& options) {
  autopilot::Signals signals;
  simulator::Truth truth;
  Recorder recorder(file, {.file = options, .topics = {}});
  recorder.metadata("run", {{"seed", "7"}, {"digest", "abc"}});
  recorder.add("/autopilot/signals", signals);
  recorder.add("/autopilot/setpoint", signals.setpoint);
  recorder.add("/truth", truth, milliseconds(10));
  for (int tick = 0; tick < kTicks; ++tick) {
    signals = signals_at(tick);
    truth.stamp = milliseconds(tick);
    for (std::size_t i = 0; i < truth.rotor_speed.size(); ++i)
      truth.rotor_speed[i] = tick + 0.5 * static_cast<double>(i);
    recorder.observe(milliseconds(tick));
  }
  recorder.close();
}

/// What the foreign reader prints of the file, and the values that it is asked for.
json read_foreign(const std::filesystem::path& file, const std::vector<std::string>& wanted) {
  std::string command = "node '" + (kReaderFolder / "read_log.mjs").string() + "' '" + file.string() + "'";
  for (const std::string& value : wanted) command += " '" + value + "'";
  command += " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + command);
  std::string output;
  std::array<char, 4096> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  if (::pclose(pipe) != 0) throw std::runtime_error("the foreign reader failed:\n" + output);
  return json::parse(output);
}

struct LayoutCase {
  const char* name;
  McapOptions options;
};

class ForeignReaderTest : public ::testing::TestWithParam<LayoutCase> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::filesystem::exists(kReaderFolder / "node_modules" / "@mcap" / "core"))
        << "the foreign reader is not installed in " << kReaderFolder << ": run ci/setup";
  }
};

TEST_P(ForeignReaderTest, FindsEveryMessageAndValue) {
  const LayoutCase& layout = GetParam();
  const auto file =
      std::filesystem::path(::testing::TempDir()) / (std::string("foreign_") + layout.name + ".mcap");
  write_log(file, layout.options);
  const std::vector<std::pair<std::string, json>> expected{
      {"/autopilot/signals:8:time", "8000000"},
      {"/autopilot/signals:8:sensors.imu.stamp", {{"sec", 0}, {"nanosec", 8000000}}},
      {"/autopilot/signals:8:sensors.imu.f_b", {{"x", 0.5}, {"y", -0.25}, {"z", -9.81}}},
      {"/autopilot/signals:8:sensors.mag.0.m_b", {{"x", 0.125}, {"y", 8}, {"z", -1}}},
      {"/autopilot/signals:9:sensors.mag", json::array()},
      {"/autopilot/signals:9:estimate.q_nb", {{"x", -0.5}, {"y", 0.5}, {"z", 0.5}, {"w", 0.5}}},
      {"/autopilot/signals:9:estimate.health", 2},
      {"/autopilot/signals:9:route.waypoints.1.kind", 2},
      {"/autopilot/signals:9:route.waypoints.1.p_n", {{"x", 1}, {"y", 2}, {"z", -3}}},
      {"/autopilot/signals:399:setpoint.rate_throttle.0.throttle", 0.25},
      {"/autopilot/setpoint:8:kind", 12},
      {"/autopilot/setpoint:9:kind", 7},
      {"/truth:39:rotor_speed", {390, 390.5, 391, 391.5, 392, 392.5, 393, 393.5}}};
  std::vector<std::string> wanted;
  for (const auto& [path, value] : expected) wanted.push_back(path);

  const json found = read_foreign(file, wanted);
  EXPECT_EQ(found.at("header"), (json{{"profile", "ros2"}, {"library", "ironbird"}}));
  EXPECT_TRUE(found.at("closed"));
  EXPECT_EQ(found.at("metadata").at("run"), (json{{"seed", "7"}, {"digest", "abc"}}));
  const json& topics = found.at("topics");
  EXPECT_EQ(topics.at("/autopilot/signals").at("count"), kTicks);
  EXPECT_EQ(topics.at("/autopilot/signals").at("schema"), "ironbird_msgs/msg/Signals");
  EXPECT_EQ(topics.at("/truth").at("count"), kTicks / 10);
  EXPECT_TRUE(topics.at("/truth").at("qos"));
  EXPECT_EQ(found.at("statistics").at("messages"), std::to_string(2 * kTicks + kTicks / 10));
  if (!layout.options.journal) {
    EXPECT_EQ(found.at("indexed"), (json{{"count", 2 * kTicks + kTicks / 10}, {"ordered", true}}));
  }
  for (const auto& [path, value] : expected) EXPECT_EQ(found.at("values").at(path), value) << path;
}

INSTANTIATE_TEST_SUITE_P(Layouts, ForeignReaderTest,
                         ::testing::Values(LayoutCase{"Stored", {}},
                                           LayoutCase{"Compressed", {.compress = true}},
                                           LayoutCase{"SmallChunks", {.chunk_size = 4096}},
                                           LayoutCase{"Journal", {.journal = true}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace ironbird::scenarios
