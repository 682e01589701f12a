#include "scenarios/record/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "autopilot/signals.hpp"
#include "scenarios/record/recorder.hpp"
#include "scenarios/record/test/by_hand.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / (name + "_" + std::to_string(getpid()) + ".mcap");
}

TEST(LogTest, ReadsBackWhatTheRecorderWrote) {
  const std::filesystem::path file = temporary("log_test");
  autopilot::Signals signals;
  simulator::Truth truth;
  Recorder recorder(file);
  recorder.metadata("run", {{"seed", "7"}});
  recorder.add("/autopilot/signals", signals);
  recorder.add("/autopilot/setpoint", signals.setpoint);
  recorder.add("/truth", truth, milliseconds(5));
  for (int i = 0; i < 10; ++i) {
    signals.estimate.p_NB_N = {1.0 * i, 2.0, 3.0};
    if (i == 3) signals.sensors.mag = autopilot::MagSample{milliseconds(1), {0.5, 0.0, 0.0}};
    if (i == 4) signals.sensors.mag.reset();
    if (i == 5) signals.setpoint = autopilot::RateThrottle{{1, 2, 3}, 0.25};
    truth.rotor_speed[2] = 100.0 + i;
    recorder.observe(milliseconds(i));
  }
  recorder.close();

  const Log log = Log::read(file);
  EXPECT_FALSE(log.truncated());
  EXPECT_EQ(log.metadata().at("run").at("seed"), "7");
  const LogTopic* signal = log.topic("/autopilot/signals");
  ASSERT_NE(signal, nullptr);
  EXPECT_EQ(signal->time().size(), 10u);
  EXPECT_EQ(signal->column("estimate.p_NB_N.x")[7], 7.0);
  EXPECT_TRUE(std::isnan(signal->column("sensors.mag.m_B.x")[2]));
  EXPECT_EQ(signal->column("sensors.mag.m_B.x")[3], 0.5);
  const LogTopic* setpoint = log.topic("/autopilot/setpoint");
  EXPECT_EQ(setpoint->column("kind")[5], 7.0);
  EXPECT_EQ(setpoint->column("rate_throttle.throttle")[5], 0.25);
  EXPECT_EQ(log.topic("/truth")->time().size(), 2u);
  EXPECT_EQ(log.topic("/truth")->column("rotor_speed[2]")[1], 105.0);
}

using namespace by_hand;  // NOLINT: the tests below write bytes
const std::string kByte = magic() + schema(1, "some_msgs/msg/Byte", "uint8 value\n");

std::string byte_message(int channel_id, std::uint64_t time, std::uint64_t value) {
  return message(channel_id, 0, time, std::string("\0\1\0\0", 4) + u8(value));
}

TEST(LogTest, TakesATopicFromAllChannelsOfItsSchemaInTheOrderOfTheFile) {
  const std::string channels =
      channel(1, 1, "/a") + channel(2, 1, "/a") + channel(3, 2, "/a") + channel(4, 1, "/b");
  const std::string messages = byte_message(2, 1000000000, 10) + byte_message(1, 2000000000, 20) +
                               byte_message(3, 3000000000, 30) + byte_message(4, 4000000000, 40) +
                               byte_message(2, 5000000000, 50);
  const Log log = Log::read(write_file(temporary("log_channels"), kByte + channels + messages));
  EXPECT_THAT(log.topics(), ::testing::ElementsAre("/a", "/b"));
  EXPECT_THAT(log.topic("/a")->column("value"), ::testing::ElementsAre(10, 20, 50));
  EXPECT_THAT(log.topic("/a")->time(), ::testing::ElementsAre(1.0, 2.0, 5.0));
  EXPECT_THAT(log.topic("/b")->column("value"), ::testing::ElementsAre(40));
}

TEST(LogTest, BoundsWhatAllTopicsTogetherFill) {
  std::string bytes = magic() + schema(1, "some_msgs/msg/Many", "float64[4096] values\n");
  for (int i = 1; i <= 100; ++i) bytes += channel(i, 1, "/" + std::to_string(i));
  const Log log = Log::read(write_file(temporary("log_topics"), bytes));
  int read = 0;
  try {
    for (const std::string& name : log.topics()) read += log.topic(name)->fields().size() == 4096 ? 1 : 0;
    FAIL() << "all were read";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("too much for a file of"));
  }
  EXPECT_GT(read, 10);
}

}  // namespace
}  // namespace ironbird::scenarios
