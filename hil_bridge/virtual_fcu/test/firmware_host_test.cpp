#include "hil_bridge/virtual_fcu/firmware_host.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace ironbird::hil_bridge {
namespace {

using namespace rosflight;
using virtual_fcu::parameter;

constexpr Time kHostTick = std::chrono::microseconds(2500);

VirtualFcuConfig quad() {
  VirtualFcuConfig config;
  config.parameters = {{"PRIMARY_MIXER", 2},   {"FAILSAFE_THR", 0.3}, {"GYRO_X_BIAS", 1e-9},
                       {"RC_NUM_CHN", 8},      {"RC_ARM_CHN", 4},     {"RC_ATT_OVRD_CHN", 5},
                       {"RC_THR_OVRD_CHN", 5}, {"RC_OVRD_LAG_T", 0}};
  config.calibrate_imu_at_start = false;
  return config;
}

/// A host fed with a vehicle at rest.
class Bench {
 public:
  explicit Bench(const VirtualFcuConfig& config) : host(config) {}

  void tick(int count = 1) {
    for (int k = 0; k < count; ++k) {
      const Time now = host.now() + kHostTick;
      simulator::Readings readings;
      readings.imu = simulator::ImuReading{.taken = now, .f_B = {0.0, 0.0, -9.80665}};
      host.tick(readings, now);
      host.receive(inbox);
    }
  }
  /// Armed, the companion in control, nothing commanded yet.
  void hand_over() {
    tick(8);
    host.pilot().arm(true);
    tick(8);
    host.pilot().override_companion(false);
    tick(8);
    ASSERT_TRUE(host.firmware().arming().armed());
  }
  template <class M>
  std::vector<Arrival> arrivals() const {
    std::vector<Arrival> found;
    for (const Arrival& a : inbox) {
      if (std::holds_alternative<M>(a.message)) found.push_back(a);
    }
    return found;
  }
  double throttle() const { return host.commands().throttle[0]; }

  FirmwareHost host;
  std::vector<Arrival> inbox;
};

OffboardControl thrust(float up) {
  return {.u = {0, 0, -up}, .ignore = 0, .mode = 0};
}

/// Ticks from sending a command to the first output that obeys it, RC frames coming with every tick.
int ticks_until_obeyed(VirtualFcuConfig config) {
  config.rc_rate = 400.0;
  Bench bench(config);
  bench.hand_over();
  bench.host.send(thrust(0.5F));
  int ticks = 0;
  while (ticks < 50 && bench.throttle() < 0.4) {
    bench.tick();
    ++ticks;
  }
  return ticks;
}

TEST(FirmwareHostTest, ObeysACommandInTheNextTick) {
  EXPECT_EQ(ticks_until_obeyed(quad()), 1);
}

TEST(FirmwareHostTest, ObeysOneTickLaterWithASinglePass) {
  VirtualFcuConfig config = quad();
  config.two_passes = false;
  EXPECT_EQ(ticks_until_obeyed(config), 2);
}

TEST(FirmwareHostTest, ObeysLaterByTheUplinkLatency) {
  VirtualFcuConfig config = quad();
  config.uplink_latency = 3 * kHostTick;
  EXPECT_EQ(ticks_until_obeyed(config), 4);
}

TEST(FirmwareHostTest, WaitsForTheNextRcFrame) {
  VirtualFcuConfig config = quad();
  config.rc_rate = 50.0;  // every eighth tick
  Bench bench(config);
  bench.hand_over();  // ends with a tick that had an RC frame
  bench.host.send(thrust(0.5F));
  bench.tick(7);
  EXPECT_LT(bench.throttle(), 0.2);
  bench.tick();
  EXPECT_NEAR(bench.throttle(), 0.5, 1e-5);
}

TEST(FirmwareHostTest, DeliversTelemetryAfterTheDownlinkLatency) {
  for (const int late : {0, 2}) {
    VirtualFcuConfig config = quad();
    config.downlink_latency = late * kHostTick;
    Bench bench(config);
    bench.tick(10);
    const auto imus = bench.arrivals<SmallImu>();
    ASSERT_EQ(imus.size(), static_cast<std::size_t>(10 - late));
    EXPECT_EQ(imus[0].when, (1 + late) * kHostTick);
    EXPECT_EQ(std::get<SmallImu>(imus[0].message).time_boot_us, 2500U);
  }
}

TEST(FirmwareHostTest, SendsRcFramesAtTheirRateOrInEveryPass) {
  Bench slow(quad());
  slow.tick(400);
  EXPECT_EQ(slow.arrivals<RcChannels>().size(), 100U);
  VirtualFcuConfig config = quad();
  config.rc_every_pass = true;
  Bench fast(config);
  fast.tick(400);
  EXPECT_EQ(fast.arrivals<RcChannels>().size(), 800U);
}

TEST(FirmwareHostTest, RoundsOutputsDownToThePulseResolution) {
  VirtualFcuConfig config = quad();
  config.pwm_resolution = 0.001;
  config.rc_rate = 400.0;
  Bench bench(config);
  bench.hand_over();
  bench.host.send(thrust(0.45678F));
  bench.tick();
  EXPECT_NEAR(bench.throttle(), 0.456, 1e-12);
}

TEST(FirmwareHostTest, CalibratesTheImuInTheFirstThousandAndOneTicks) {
  VirtualFcuConfig config = quad();
  config.parameters[2].value = 0.0;
  config.calibrate_imu_at_start = true;
  Bench bench(config);
  bench.tick(1000);
  EXPECT_EQ(bench.host.firmware().arming().errors(), virtual_fcu::kUncalibratedImu);
  bench.tick(1);
  EXPECT_EQ(bench.host.firmware().arming().errors(), 0);
}

TEST(FirmwareHostTest, HoldsItsOutputsThroughAnImuDropout) {
  Bench bench(quad());
  bench.hand_over();
  bench.host.send(thrust(0.5F));
  bench.tick(4);
  for (int k = 0; k < 100; ++k) bench.host.tick({}, bench.host.now() + kHostTick);
  EXPECT_NEAR(bench.throttle(), 0.5, 1e-5);
}

TEST(FirmwareHostTest, TranslatesASatelliteFix) {
  FirmwareHost host(quad());
  simulator::Readings readings;
  readings.gnss = simulator::GnssReading{.taken = std::chrono::milliseconds(1250),
                                         .latitude = std::numbers::pi / 4,
                                         .longitude = -std::numbers::pi / 2,
                                         .altitude = 1387.0,
                                         .v_NB_N = {1.5, -0.25, 0.125},
                                         .horizontal_accuracy = 0.21,
                                         .vertical_accuracy = 0.4,
                                         .speed_accuracy = 0.01,
                                         .fix = 3,
                                         .satellites = 15};
  host.tick(readings, std::chrono::seconds(2));
  std::vector<Arrival> inbox;
  host.receive(inbox);
  const RosflightGnss* fix = nullptr;
  for (const Arrival& a : inbox) {
    if (const auto* message = std::get_if<RosflightGnss>(&a.message)) fix = message;
  }
  ASSERT_NE(fix, nullptr);
  EXPECT_NEAR(fix->lat, 45.0, 1e-12);
  EXPECT_NEAR(fix->lon, -90.0, 1e-12);
  EXPECT_EQ(fix->nanos, 250000000);
  EXPECT_EQ(fix->rosflight_timestamp, 1250000U);
  EXPECT_EQ(fix->vel_n, 1.5F);
  EXPECT_EQ(fix->num_sat, 15);
}

struct BadConfig {
  const char* name;
  void (*spoil)(VirtualFcuConfig&);
};

TEST(FirmwareHostTest, RefusesAConfigurationThatMakesNoSense) {
  for (const BadConfig& bad :
       {BadConfig{"tick", [](VirtualFcuConfig& c) { c.tick = Time(0); }},
        BadConfig{"tick", [](VirtualFcuConfig& c) { c.tick = Time(2500001); }},
        BadConfig{"rc_rate", [](VirtualFcuConfig& c) { c.rc_rate = 60.0; }},
        BadConfig{"rc_rate",
                  [](VirtualFcuConfig& c) { c.rc_rate = std::numeric_limits<double>::quiet_NaN(); }},
        BadConfig{"uplink_latency", [](VirtualFcuConfig& c) { c.uplink_latency = Time(1); }},
        BadConfig{"downlink_latency", [](VirtualFcuConfig& c) { c.downlink_latency = -kHostTick; }},
        BadConfig{"pwm_resolution", [](VirtualFcuConfig& c) { c.pwm_resolution = -1.0; }},
        BadConfig{"parameters.NOPE", [](VirtualFcuConfig& c) {
                    c.parameters.push_back({"NOPE", 1.0});
                  }}}) {
    VirtualFcuConfig config = quad();
    bad.spoil(config);
    try {
      FirmwareHost host(config);
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("fcu.") + bad.name), std::string::npos)
          << error.what();
    }
  }
}

// ---- RcPilot ----

TEST(RcPilotTest, ArmsWithTheSticksWhenThereIsNoSwitch) {
  VirtualFcuConfig config = quad();
  config.parameters[4] = {"RC_ARM_CHN", -1};
  Bench bench(config);
  bench.tick(8);
  bench.host.pilot().arm(true);
  bench.tick(480);
  EXPECT_TRUE(bench.host.firmware().arming().armed());
  EXPECT_NEAR(bench.host.firmware().rc().sticks().z, 0.0F, 1e-6F) << "and lets go of the stick";
  bench.host.pilot().arm(false);
  bench.tick(480);
  EXPECT_FALSE(bench.host.firmware().arming().armed());
}

TEST(RcPilotTest, GivesTheGestureUpAfterThreeSeconds) {
  VirtualFcuConfig config = quad();
  config.parameters[4] = {"RC_ARM_CHN", -1};
  config.parameters[1] = {"FAILSAFE_THR", -1.0};  // cannot arm
  Bench bench(config);
  bench.host.pilot().arm(true);
  bench.tick(1100);
  EXPECT_GT(bench.host.firmware().rc().sticks().z, 0.9F);
  bench.tick(200);
  EXPECT_EQ(bench.host.firmware().rc().sticks().z, 0.0F);
}

TEST(RcPilotTest, FliesWithSticksThroughInvertedSwitches) {
  VirtualFcuConfig config = quad();
  config.parameters.push_back({"SWITCH_5_DIR", -1});
  Bench bench(config);
  bench.tick(8);
  EXPECT_FALSE(bench.host.firmware().arming().armed());
  bench.host.pilot().arm(true);
  bench.tick(8);
  EXPECT_TRUE(bench.host.firmware().arming().armed());
  bench.host.pilot().set_stick(Stick::kThrottle, 0.8);
  bench.host.pilot().set_stick(Stick::kRoll, -3.0);
  bench.tick(4);
  EXPECT_FLOAT_EQ(bench.host.firmware().rc().sticks().throttle, 0.8F);
  EXPECT_FLOAT_EQ(bench.host.firmware().rc().sticks().x, -1.0F);
}

TEST(RcPilotTest, LosesItsLinkLoudlyOrSilently) {
  Bench bench(quad());
  bench.hand_over();
  bench.host.pilot().lose();
  bench.tick(4);
  EXPECT_TRUE(bench.host.firmware().arming().failsafe());
  bench.host.pilot().find();
  bench.tick(4);
  EXPECT_FALSE(bench.host.firmware().arming().failsafe());
  bench.host.pilot().fall_silent();
  bench.inbox.clear();
  bench.tick(400);
  EXPECT_TRUE(bench.arrivals<RcChannels>().empty());
  EXPECT_EQ(bench.host.firmware().arming().errors(), 0) << "silence is not noticed";
}

}  // namespace
}  // namespace ironbird::hil_bridge
