#include "autopilot/math/finite.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "autopilot/types/control_setpoint.hpp"
#include "autopilot/types/mission.hpp"
#include "autopilot/types/state_estimate.hpp"

namespace ironbird::autopilot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FiniteTest, LooksIntoVectorsQuaternionsOptionalsAndNestedStructs) {
  StateEstimate estimate;
  EXPECT_TRUE(all_finite(estimate));
  estimate.origin.latitude = kNan;
  EXPECT_FALSE(all_finite(estimate));
  estimate = StateEstimate{};
  estimate.q_NB.x() = kNan;
  EXPECT_FALSE(all_finite(estimate));
  estimate = StateEstimate{};
  estimate.v_NB_B.z() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(all_finite(estimate));
  Waypoint waypoint;
  waypoint.geodetic = GeodeticPosition{.latitude = 0.0, .longitude = 0.0, .altitude = kNan};
  EXPECT_FALSE(all_finite(waypoint));
}

TEST(FiniteTest, LooksAtTheAlternativeThatIsHeld) {
  ControlSetpoint setpoint = NoSetpoint{};
  EXPECT_TRUE(all_finite(setpoint));
  setpoint = AngleHeadingRateThrust{.roll = 0.0, .pitch = 0.0, .heading_rate = 0.0, .thrust = kNan};
  EXPECT_FALSE(all_finite(setpoint));
}

}  // namespace
}  // namespace ironbird::autopilot
