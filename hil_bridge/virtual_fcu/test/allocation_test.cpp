#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "hil_bridge/virtual_fcu/firmware_host.hpp"

namespace {

long allocations = 0;

}  // namespace

// Every request for memory in this program passes here and is counted.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace ironbird::hil_bridge {
namespace {

TEST(FirmwareAllocationTest, FliesWithoutAskingForMemory) {
  VirtualFcuConfig config;
  config.parameters = {{"PRIMARY_MIXER", 2}, {"FAILSAFE_THR", 0.3},  {"GYRO_X_BIAS", 1e-9}, {"RC_NUM_CHN", 8},
                       {"RC_ARM_CHN", 4},    {"RC_ATT_OVRD_CHN", 5}, {"RC_THR_OVRD_CHN", 5}};
  config.calibrate_imu_at_start = false;
  config.uplink_latency = 2 * config.tick;
  config.downlink_latency = 2 * config.tick;
  FirmwareHost host(config);
  std::vector<Arrival> inbox;
  inbox.reserve(256);
  host.pilot().arm(true);
  const auto fly = [&](int ticks) {
    for (int k = 0; k < ticks; ++k) {
      const Time now = host.now() + config.tick;
      simulator::Readings readings;
      readings.imu = simulator::ImuReading{.taken = now, .f_B = {0.1, 0.0, -9.8}};
      if (k % 4 == 0) readings.mag = simulator::MagReading{.taken = now};
      if (k % 8 == 0) readings.baro = simulator::BaroReading{.taken = now};
      if (k % 40 == 0) readings.gnss = simulator::GnssReading{.taken = now};
      if (k % 40 == 0) readings.battery = simulator::BatteryReading{.taken = now, .voltage = 24.0};
      host.tick(readings, now);
      inbox.clear();
      host.receive(inbox);
      host.send(rosflight::OffboardControl{.u = {0, 0, 0.5F}, .ignore = 0, .mode = 2});
    }
  };
  fly(400);
  ASSERT_TRUE(host.firmware().arming().armed());
  const long before = allocations;
  ASSERT_GT(before, 0);
  fly(4000);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace ironbird::hil_bridge
