#include "autopilot/controller/flight_phase.hpp"

#include <gtest/gtest.h>

#include "autopilot/controller/touch_down.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

struct Row {
  const char* name;
  FlightPhase from;
  PhaseInputs in;
  FlightPhase to;
};

PhaseInputs armed(void (*change)(PhaseInputs&)) {
  PhaseInputs in;
  in.armed = true;
  in.estimate_usable = true;
  change(in);
  return in;
}

PhaseInputs everything_but_armed() {
  return {.armed = false,
          .estimate_usable = true,
          .take_off_wanted = true,
          .height_reached = true,
          .hold_over = true,
          .setpoint_valid = true,
          .route_lands = true,
          .landing_wanted = true,
          .on_ground = true};
}

class FlightPhaseTest : public ::testing::TestWithParam<Row> {};

TEST_P(FlightPhaseTest, GoesWhereTheTableSays) {
  EXPECT_EQ(next_phase(GetParam().from, GetParam().in), GetParam().to);
}

const auto kNothing = [](PhaseInputs&) {};

INSTANTIATE_TEST_SUITE_P(
    Rows, FlightPhaseTest,
    ::testing::Values(
        Row{"DisarmedStays", kDisarmed, everything_but_armed(), kDisarmed},
        Row{"TakeOffIsDisarmed", kTakeOff, everything_but_armed(), kDisarmed},
        Row{"HoldIsDisarmed", kHold, everything_but_armed(), kDisarmed},
        Row{"OffboardIsDisarmed", kOffboard, everything_but_armed(), kDisarmed},
        Row{"LandingIsDisarmed", kLanding, everything_but_armed(), kDisarmed},
        Row{"ArmedWaitsForARequest", kDisarmed, armed([](PhaseInputs& i) { i.setpoint_valid = true; }),
            kDisarmed},
        Row{"ArmedTakesOff", kDisarmed, armed([](PhaseInputs& i) { i.take_off_wanted = true; }), kTakeOff},
        Row{"NoTakeOffWithoutAnEstimate", kDisarmed, armed([](PhaseInputs& i) {
              i.take_off_wanted = true;
              i.estimate_usable = false;
            }),
            kDisarmed},
        Row{"NoLandingOnTheGround", kDisarmed, armed([](PhaseInputs& i) { i.landing_wanted = true; }),
            kDisarmed},
        Row{"Climbs", kTakeOff, armed(kNothing), kTakeOff},
        Row{"HasClimbed", kTakeOff, armed([](PhaseInputs& i) { i.height_reached = true; }), kHold},
        Row{"LandsFromTheClimb", kTakeOff,
            armed([](PhaseInputs& i) { i.landing_wanted = i.height_reached = true; }), kLanding},
        Row{"Holds", kHold, armed([](PhaseInputs& i) { i.setpoint_valid = true; }), kHold},
        Row{"HoldsWithNothingToFly", kHold, armed([](PhaseInputs& i) { i.hold_over = true; }), kHold},
        Row{"FliesAfterTheHold", kHold, armed([](PhaseInputs& i) { i.hold_over = i.setpoint_valid = true; }),
            kOffboard},
        Row{"LandsFromTheHold", kHold,
            armed([](PhaseInputs& i) { i.landing_wanted = i.hold_over = i.setpoint_valid = true; }),
            kLanding},
        Row{"IgnoresALandingOfTheRouteInTheHold", kHold, armed([](PhaseInputs& i) { i.route_lands = true; }),
            kHold},
        Row{"FliesOn", kOffboard, armed([](PhaseInputs& i) { i.setpoint_valid = true; }), kOffboard},
        Row{"HoldsWhenTheSetpointIsGone", kOffboard, armed(kNothing), kHold},
        Row{"LandsByRequest", kOffboard, armed([](PhaseInputs& i) { i.landing_wanted = true; }), kLanding},
        Row{"LandsByRoute", kOffboard, armed([](PhaseInputs& i) { i.route_lands = i.setpoint_valid = true; }),
            kLanding},
        Row{"IgnoresAStaleLandingOfTheRoute", kOffboard, armed([](PhaseInputs& i) { i.route_lands = true; }),
            kHold},
        Row{"Descends", kLanding, armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = true; }),
            kLanding},
        Row{"StaysDown", kLanding, armed([](PhaseInputs& i) { i.on_ground = i.setpoint_valid = true; }),
            kLanding},
        Row{"TakesOffAgainFromTheGround", kLanding,
            armed([](PhaseInputs& i) { i.on_ground = i.take_off_wanted = true; }), kTakeOff},
        Row{"DoesNotTakeOffWhileDescending", kLanding,
            armed([](PhaseInputs& i) { i.take_off_wanted = true; }), kLanding}),
    [](const auto& case_) { return case_.param.name; });

TEST(TouchDownTest, IsFeltWhenNothingMovesUnderLittleLiftForAWhile) {
  TouchDown touch_down;
  using std::chrono::milliseconds;
  const auto feel = [&](int at, double lift, double v_down) {
    return touch_down.feel(milliseconds(at), lift, v_down, 0.15, 0.95, 1.0);
  };
  EXPECT_FALSE(feel(0, 0.8, 0.4)) << "it sinks";
  EXPECT_FALSE(feel(100, 0.8, 0.0));
  EXPECT_FALSE(feel(900, 0.8, 0.0));
  EXPECT_FALSE(feel(1000, 1.0, 0.0)) << "it is carried: the wait begins anew";
  EXPECT_FALSE(feel(1100, 0.8, 0.0));
  EXPECT_FALSE(feel(2099, 0.8, 0.1));
  EXPECT_TRUE(feel(2100, 0.8, -0.1));
  EXPECT_TRUE(feel(2200, 1.0, 1.0)) << "it stays felt";
  touch_down.reset();
  EXPECT_FALSE(touch_down.felt());
}

}  // namespace
}  // namespace ironbird::autopilot
