#include "scenarios/bench/waypoint_text.hpp"

#include <gtest/gtest.h>

namespace ironbird::scenarios {
namespace {

TEST(WaypointTextTest, SaysWhereItIsAndWhatToDoThere) {
  autopilot::Waypoint waypoint;
  waypoint.p_N << 0.0, 0.0, -5.0;
  EXPECT_EQ(line_about(waypoint, 0), "0: goto at (0.00, 0.00, -5.00) m, heading 0.00 deg");
  waypoint.kind = autopilot::WaypointKind::kHold;
  waypoint.p_N << -20.0, 0.5, -8.0;
  waypoint.heading = 1.5707963267948966;
  waypoint.speed = 1.5;
  waypoint.hold_time = 10.0;
  EXPECT_EQ(line_about(waypoint, 1),
            "1: hold at (-20.00, 0.50, -8.00) m, heading 90.00 deg, at most 1.50 m/s, for 10.00 s");
  waypoint.hold_indefinitely = true;
  waypoint.speed = 0.0;
  EXPECT_EQ(line_about(waypoint, 2), "2: hold at (-20.00, 0.50, -8.00) m, heading 90.00 deg, until released");
}

TEST(WaypointTextTest, GivesAPlaceOnTheEarthInDegreesToTheCentimetre) {
  autopilot::Waypoint waypoint;
  waypoint.kind = autopilot::WaypointKind::kLand;
  waypoint.geodetic = autopilot::GeodeticPosition{0.7, -1.94, 1400.0};
  EXPECT_EQ(line_about(waypoint, 7),
            "7: land at latitude 40.1070457 deg, longitude -111.1538123 deg, altitude 1400.00 m, heading "
            "0.00 deg");
}

}  // namespace
}  // namespace ironbird::scenarios
