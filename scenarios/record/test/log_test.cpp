#include "scenarios/record/log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "autopilot/signals.hpp"
#include "scenarios/record/recorder.hpp"
#include "simulator/types/truth.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;

TEST(LogTest, ReadsBackWhatTheRecorderWrote) {
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / ("log_test_" + std::to_string(getpid()) + ".mcap");
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

}  // namespace
}  // namespace ironbird::scenarios
