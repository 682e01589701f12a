#include "scenarios/record/logged_route.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "autopilot/signals.hpp"
#include "scenarios/record/recorder.hpp"

namespace ironbird::scenarios {
namespace {

using std::chrono::milliseconds;

class LoggedRouteTest : public ::testing::Test {
 protected:
  ~LoggedRouteTest() override { std::filesystem::remove(file_); }

  void put(Recorder& recorder, int waypoints, double first_x, int at) {
    signals_.route.waypoints.assign(static_cast<std::size_t>(waypoints), {});
    for (int i = 0; i < waypoints; ++i)
      signals_.route.waypoints[static_cast<std::size_t>(i)].p_N = {first_x + i, 0.0, -5.0};
    recorder.write_once("/autopilot/route", signals_.route, milliseconds(at));
  }

  std::filesystem::path file_ =
      std::filesystem::path(::testing::TempDir()) / ("logged_route_" + std::to_string(getpid()) + ".mcap");
  autopilot::Signals signals_;
};

TEST_F(LoggedRouteTest, OfTheRunIsTheOneThatWasInForceLongest) {
  {
    Recorder recorder(file_);
    recorder.add("/autopilot/trajectory", signals_.trajectory, milliseconds(100));
    put(recorder, 5, 100.0, 0);
    for (int i = 0; i <= 100; ++i) {
      if (i == 10) put(recorder, 2, 0.0, 1000);
      if (i == 70) put(recorder, 3, 0.0, 7000);
      if (i == 90) put(recorder, 0, 0.0, 9000);
      recorder.observe(milliseconds(100 * i));
    }
    recorder.close();
  }
  const std::vector<LoggedRoute> routes = logged_routes(Log::read(file_));
  ASSERT_EQ(routes.size(), 4U);
  EXPECT_EQ(routes[0].waypoints_N.size(), 5U);
  EXPECT_DOUBLE_EQ(routes[1].since, 1.0);
  EXPECT_DOUBLE_EQ(routes[1].until, 7.0);
  EXPECT_DOUBLE_EQ(routes[3].until, 10.0) << "until the log ends";
  EXPECT_EQ(main_route(routes), 1U);
  EXPECT_TRUE(routes[2].begins_like(routes[1]));
  EXPECT_FALSE(routes[0].begins_like(routes[1]));
  EXPECT_FALSE(routes[3].begins_like(routes[1]));
}

TEST_F(LoggedRouteTest, IsNoneInALogWithoutWaypoints) {
  {
    Recorder recorder(file_);
    put(recorder, 0, 0.0, 0);
    recorder.close();
  }
  EXPECT_FALSE(main_route(logged_routes(Log::read(file_))));
}

}  // namespace
}  // namespace ironbird::scenarios
