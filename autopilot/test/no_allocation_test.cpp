#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "autopilot/autopilot.hpp"
#include "autopilot/test/little_vehicle.hpp"

namespace {
std::size_t allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace ironbird::autopilot {
namespace {

class NoAllocationTest : public ::testing::TestWithParam<const char*> {};

TEST_P(NoAllocationTest, StepNeverAllocatesWhileTakingOffFlyingHoldingAndLanding) {
  // GIVEN a route with a hold and a landing
  AutopilotConfig config;
  config.estimator.kind = "external_pose";
  config.path_manager.kind = GetParam();
  Autopilot autopilot(config, standard_modules());
  LittleVehicle vehicle;
  SetRoute route;
  for (int i = 0; i < 20; ++i) {
    Waypoint waypoint;
    waypoint.p_N << i % 2, 0.2 * i, -4.0;
    waypoint.kind = i == 10 ? WaypointKind::kHold : i == 19 ? WaypointKind::kLand : WaypointKind::kGoto;
    waypoint.hold_time = 0.5;
    route.waypoints.push_back(waypoint);
  }
  ASSERT_TRUE(autopilot.request(RouteRequest{route}).accepted);
  vehicle.status.armed = true;
  vehicle.fly(autopilot.step(vehicle.frame()));
  ASSERT_TRUE(autopilot.request(TakeOff{}).accepted);
  // WHEN it flies all of it
  const std::size_t before = allocations;
  bool landed = false;
  int steps = 0;
  for (; steps < 40000 && !landed; ++steps) {
    vehicle.fly(autopilot.step(vehicle.frame()));
    landed = autopilot.signals().flight.phase == FlightPhase::kLanding && vehicle.p_NB_N.z() >= 0.0;
  }
  // THEN nothing was allocated
  EXPECT_EQ(allocations - before, 0u);
  EXPECT_TRUE(landed);
  EXPECT_GT(steps, 1000);
}

INSTANTIATE_TEST_SUITE_P(Managers, NoAllocationTest,
                         ::testing::Values("smoothstep_manager", "minimum_snap_manager"),
                         [](const auto& case_) { return std::string(case_.param); });

TEST(NoAllocation, StepNeverAllocatesWithTheFilters) {
  for (const char* kind : {"ekf", "error_state"}) {
    AutopilotConfig config;
    config.estimator.kind = kind;
    Autopilot autopilot(config, standard_modules());
    SensorFrame frame;
    frame.status = FcuStatus{};
    frame.status->armed = true;
    autopilot.step(frame);
    const std::size_t before = allocations;
    for (int i = 1; i <= 1000; ++i) {
      frame.imu.stamp = std::chrono::microseconds(2500 * i);
      frame.imu.f_B << 0.0, 0.0, -9.81;
      frame.mag = MagSample{frame.imu.stamp, Vector3(0.4, 0.0, 0.9)};
      frame.baro = BaroSample{frame.imu.stamp, 101325.0, 288.15};
      frame.gnss.reset();
      if (i % 40 == 0) {
        frame.gnss = GnssSample{};
        frame.gnss->stamp = frame.imu.stamp;
        frame.gnss->fix = GnssFix::kFix3D;
        frame.gnss->latitude = 0.7;
      }
      autopilot.step(frame);
    }
    EXPECT_EQ(allocations - before, 0u) << kind;
  }
}

TEST(NoAllocation, CountsAllocationsAtAll) {
  const std::size_t before = allocations;
  delete new int(1);
  EXPECT_EQ(allocations - before, 1u);
}

}  // namespace
}  // namespace ironbird::autopilot
