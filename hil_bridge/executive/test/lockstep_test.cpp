#include "hil_bridge/executive/lockstep.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hil_bridge/executive/test/live_guard.hpp"
#include "hil_bridge/virtual_fcu/virtual_fcu.hpp"
#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::hil_bridge {
namespace {

using autopilot::Autopilot;
using autopilot::AutopilotConfig;

constexpr Time kTick = std::chrono::microseconds(2500);

/// Tells in its estimate which frame it was given: the IMU's stamp, and in p_N the pressure, if there was
/// one.
class TellingEstimator final : public autopilot::Estimator {
 protected:
  autopilot::StateEstimate estimate(const autopilot::SensorFrame& frame, double) override {
    autopilot::StateEstimate told;
    told.stamp = frame.imu.stamp;
    told.health = autopilot::Health::kGood;
    if (frame.baro) told.p_NB_N.x() = frame.baro->pressure;
    return told;
  }
};

/// Commands what the estimate tells: throttle in ten thousandths of the stamp's ticks, pressure as roll rate.
/// Silent while the stamp is a multiple of 100 ticks.
class TellingController final : public autopilot::Controller {
 protected:
  std::string_view refusal(autopilot::FlightWish, const autopilot::StateEstimate&,
                           const autopilot::FcuStatus&) const override {
    return "it flies by itself";
  }
  autopilot::FcuCommand control(const autopilot::ControlSetpoint&, bool,
                                const autopilot::StateEstimate& estimate, const autopilot::FcuStatus&, double,
                                autopilot::PhaseStep&) override {
    const std::int64_t ticks = estimate.stamp / kTick;
    if (ticks % 100 == 0) return autopilot::SilenceCommand{};
    return autopilot::RateCommand{.w_NB_B = {estimate.p_NB_N.x(), 0, 0},
                                  .throttle = 1e-4 * static_cast<double>(ticks)};
  }
};

std::unique_ptr<Autopilot> telling_autopilot() {
  autopilot::Modules modules = autopilot::standard_modules();
  modules.estimators.add<TellingEstimator>("telling");
  modules.controllers.add<TellingController>("telling");
  AutopilotConfig config;
  config.estimator.kind = "telling";
  config.controller.kind = "telling";
  return std::make_unique<Autopilot>(config, modules);
}

rosflight::SmallImu imu_of_tick(std::uint64_t tick) {
  return {.time_boot_us = 2500 * tick, .zacc = -9.80665F, .temperature = 300.0F};
}

/// Delivers what the test put on the line, and writes down everything that is done to it.
class ScriptedFcu final : public Fcu {
 public:
  void advance(Time now) override {
    now_ = now;
    calls.emplace_back("advance");
  }
  void receive(std::vector<Arrival>& out) override {
    calls.emplace_back("receive");
    std::erase_if(line, [&](const Arrival& arrival) {
      if (arrival.when > now_) return false;
      out.push_back(arrival);
      return true;
    });
  }
  void send(const rosflight::Message& message) override {
    calls.emplace_back(std::holds_alternative<rosflight::Heartbeat>(message) ? "heartbeat" : "command");
    sent.push_back({now_, message});
  }

  /// The ticks of the frames that the commands answer, in order of sending.
  std::vector<int> answered() const {
    std::vector<int> ticks;
    for (const Arrival& arrival : sent) {
      const auto* control = std::get_if<rosflight::OffboardControl>(&arrival.message);
      if (control != nullptr) ticks.push_back(static_cast<int>(1e4F * control->u[2] + 0.5F));
    }
    return ticks;
  }

  std::vector<Arrival> line;
  std::vector<Arrival> sent;
  std::vector<std::string> calls;

 private:
  Time now_{};
};

class LockstepTest : public ::testing::Test {
 protected:
  void tick(int count = 1) {
    for (int k = 0; k < count; ++k) lockstep.tick();
  }

  ScriptedFcu fcu;
  std::unique_ptr<Autopilot> pilot = telling_autopilot();
  test::LiveGuard live;
  Lockstep lockstep{fcu, *pilot, live.guard, kTick};
};

TEST_F(LockstepTest, RefusesAPeriodThatIsNoTime) {
  EXPECT_THROW(Lockstep(fcu, *pilot, live.guard, Time{0}), std::invalid_argument);
  EXPECT_THROW(Lockstep(fcu, *pilot, live.guard, -kTick), std::invalid_argument);
}

TEST_F(LockstepTest, CountsTimeInWholePeriods) {
  EXPECT_EQ(lockstep.now(), Time{0});
  for (int k = 1; k <= 1000; ++k) EXPECT_EQ(lockstep.tick(), k * kTick);
  EXPECT_EQ(lockstep.now(), 1000 * kTick);
}

TEST_F(LockstepTest, AdvancesThenReceivesThenCommands) {
  fcu.line = {{kTick, imu_of_tick(1)}, {2 * kTick, imu_of_tick(2)}};
  tick();
  EXPECT_EQ(fcu.calls, (std::vector<std::string>{"heartbeat", "advance", "receive", "command"}));
  fcu.calls.clear();
  tick();
  EXPECT_EQ(fcu.calls, (std::vector<std::string>{"advance", "receive", "command"}));
  EXPECT_EQ(fcu.sent.back().when, 2 * kTick) << "the command leaves in the tick of its sample";
}

TEST_F(LockstepTest, SaysThatItLivesEverySecondInTheVersionOfTheDialect) {
  tick(1000);  // 2.5 s
  ASSERT_EQ(fcu.sent.size(), 3U);
  for (const Arrival& arrival : fcu.sent) {
    EXPECT_EQ(std::get<rosflight::Heartbeat>(arrival.message).mavlink_version, 2);
  }
  // It is sent before the unit advances, so the unit still stands at the tick before.
  EXPECT_EQ(fcu.sent[1].when, std::chrono::seconds(1) - kTick);
  EXPECT_EQ(fcu.sent[2].when, std::chrono::seconds(2) - kTick);
}

TEST_F(LockstepTest, AnswersEveryFrameOfABurstInOrder) {
  for (const int k : {1, 2, 3, 4})
    fcu.line.push_back({4 * kTick, imu_of_tick(static_cast<std::uint64_t>(k))});
  tick(3);
  EXPECT_TRUE(fcu.answered().empty());
  EXPECT_FALSE(lockstep.stepped());
  tick();
  EXPECT_TRUE(lockstep.stepped());
  EXPECT_EQ(fcu.answered(), (std::vector<int>{1, 2, 3, 4}));
  tick();
  EXPECT_FALSE(lockstep.stepped());
  EXPECT_EQ(fcu.answered().size(), 4U) << "nothing is answered twice";
}

TEST_F(LockstepTest, TellsOfEveryStepOfABurstWithWhatItComputed) {
  std::vector<std::pair<Time, std::size_t>> told;  // when, and how many commands had left
  std::vector<Time> stamps;
  lockstep.on_step([&](Time now) {
    told.emplace_back(now, fcu.answered().size());
    stamps.push_back(pilot->signals().estimate.stamp);
  });
  for (const int k : {1, 2, 3}) fcu.line.push_back({4 * kTick, imu_of_tick(static_cast<std::uint64_t>(k))});
  tick(5);
  EXPECT_EQ(told,
            (std::vector<std::pair<Time, std::size_t>>{{4 * kTick, 1}, {4 * kTick, 2}, {4 * kTick, 3}}));
  EXPECT_EQ(stamps, (std::vector<Time>{kTick, 2 * kTick, 3 * kTick}));
}

TEST_F(LockstepTest, StepsForASilentCommandButSendsNothing) {
  fcu.line = {{kTick, imu_of_tick(100)}, {2 * kTick, imu_of_tick(101)}};
  tick();
  EXPECT_TRUE(lockstep.stepped());
  EXPECT_TRUE(fcu.answered().empty());
  tick();
  EXPECT_EQ(fcu.answered(), std::vector<int>{101});
}

TEST_F(LockstepTest, CarriesASlowSampleOverATickIntoTheNextFrameAndNoOther) {
  fcu.line = {{kTick, imu_of_tick(1)},
              {kTick, rosflight::SmallBaro{.pressure = 85000.0F}},
              {2 * kTick, rosflight::SmallMag{.xmag = 2e-5F, .zmag = 4e-5F}},
              {3 * kTick, imu_of_tick(3)},
              {4 * kTick, imu_of_tick(4)}};
  tick(3);
  EXPECT_TRUE(pilot->signals().sensors.mag.has_value());
  tick();
  EXPECT_FALSE(pilot->signals().sensors.mag.has_value());
  EXPECT_EQ(fcu.answered(), (std::vector<int>{1, 3, 4}));
  const float pressures[] = {0.0F, 85000.0F, 0.0F};
  std::size_t k = 0;
  for (const Arrival& arrival : fcu.sent) {
    if (const auto* control = std::get_if<rosflight::OffboardControl>(&arrival.message)) {
      EXPECT_EQ(control->u[3], pressures[k++]);
    }
  }
}

TEST_F(LockstepTest, KeepsTheLatestTelemetryAndTheTextsOfTheLastTickOnly) {
  const auto text = [](std::uint8_t severity) {
    return rosflight::Statustext{.severity = severity, .text = {}};
  };
  fcu.line = {{kTick, text(3)},
              {kTick, rosflight::RosflightStatus{.armed = 1}},
              {kTick, text(6)},
              {2 * kTick, rosflight::RosflightBatteryStatus{.battery_voltage = 24.0F}}};
  tick();
  ASSERT_EQ(lockstep.texts().size(), 2U);
  EXPECT_EQ(lockstep.texts()[0].severity, 3);
  EXPECT_EQ(lockstep.texts()[1].severity, 6);
  tick();
  EXPECT_TRUE(lockstep.texts().empty());
  EXPECT_EQ(lockstep.telemetry().status.armed, 1);
  EXPECT_EQ(lockstep.telemetry().battery.battery_voltage, 24.0F);
}

// ---- with the virtual unit ----

struct LatencyCase {
  int uplink;
  int downlink;
};

class LatencyTest : public ::testing::TestWithParam<LatencyCase> {};

TEST_P(LatencyTest, TurnsRotorsOneTickAndBothLatenciesAfterTheSample) {
  simulator::WorldConfig world_config;
  world_config.vehicle = simulator::reference_multirotor();
  world_config.initial_p_NB_N = {0.0, 0.0, -50.0};
  world_config.on_ground = false;
  simulator::World world(world_config, std::make_unique<simulator::RigidBodyPlant>());
  VirtualFcuConfig config;
  config.calibrate_imu_at_start = false;
  config.rc_rate = 400.0;  // a frame in every tick: commands wait for none
  config.uplink_latency = GetParam().uplink * kTick;
  config.downlink_latency = GetParam().downlink * kTick;
  config.parameters = {{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.3},  {"GYRO_X_BIAS", 1e-9},
                       {"RC_NUM_CHN", 8},    {"RC_ARM_CHN", 4},      {"RC_ATT_OVRD_CHN", 5},
                       {"RC_MAX_THR", 1.0},  {"RC_THR_OVRD_CHN", 5}, {"TAKE_MIN_THR", 0},
                       {"RC_OVRD_LAG_T", 0}};
  VirtualFcu fcu(config, world);
  const std::unique_ptr<Autopilot> pilot = telling_autopilot();
  test::LiveGuard live;
  Lockstep lockstep(fcu, *pilot, live.guard, kTick);
  fcu.pilot().arm(true);
  for (int k = 0; k < 8; ++k) lockstep.tick();
  fcu.pilot().override_companion(false);
  const int delay = 1 + GetParam().uplink + GetParam().downlink;
  for (int now = 9; now < 250; ++now) {
    lockstep.tick();
    ASSERT_TRUE(lockstep.stepped()) << "in tick " << now;
    ASSERT_EQ(pilot->signals().sensors.imu.stamp, (now - GetParam().downlink) * kTick) << "nothing is lost";
    const int sample = now - delay;
    if (now < 20 || sample % 100 == 0) continue;
    // THEN the throttle that is flown tells which sample it answers.
    const float flown = -fcu.firmware().mixer_inputs()[2];
    EXPECT_NEAR(1e4F * flown, static_cast<float>(sample), 1e-2F) << "in tick " << now;
  }
}

INSTANTIATE_TEST_SUITE_P(Links, LatencyTest,
                         ::testing::Values(LatencyCase{0, 0}, LatencyCase{3, 0}, LatencyCase{0, 2},
                                           LatencyCase{2, 4}));

}  // namespace
}  // namespace ironbird::hil_bridge
