#include "scenarios/config/toml_reader.hpp"

#include <gtest/gtest.h>

#include "autopilot/types/mission.hpp"
#include "scenarios/config/effective.hpp"

namespace ironbird::scenarios {
namespace {

using autopilot::Route;

TEST(TomlReaderTest, ReadsAnArrayOfTables) {
  Route route;
  read_toml(parse_toml(R"(
cyclic = true
[[waypoints]]
p_N = [0, 0, -5]
heading = "90 deg"
kind = "hold"
hold_time = "500 ms"
[[waypoints]]
geodetic = { latitude = "45 deg", altitude = 100 }
)",
                       "mission.toml"),
            route);
  ASSERT_EQ(route.waypoints.size(), 2u);
  EXPECT_EQ(route.waypoints[0].p_N.z(), -5.0);
  EXPECT_DOUBLE_EQ(route.waypoints[0].heading, 1.5707963267948966);
  EXPECT_EQ(route.waypoints[0].hold_time, 0.5);
  EXPECT_EQ(route.waypoints[1].geodetic->altitude, 100.0);

  Route again;
  read_toml(parse_toml(effective(route), "effective"), again);
  EXPECT_EQ(effective(again), effective(route)) << effective(route);
  EXPECT_EQ(config_digest(again), config_digest(route));
}

}  // namespace
}  // namespace ironbird::scenarios
