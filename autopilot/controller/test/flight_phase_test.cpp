#include "autopilot/controller/flight_phase.hpp"

#include <gtest/gtest.h>

#include "autopilot/controller/touch_down.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;
using enum PhaseCause;

struct Row {
  const char* name;
  FlightPhase from;
  PhaseInputs in;
  FlightPhase to;
  PhaseCause cause = PhaseCause::kPlanned;
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
  EXPECT_EQ(next_phase(GetParam().from, GetParam().in), (PhaseStep{GetParam().to, GetParam().cause}));
}

const auto kNothing = [](PhaseInputs&) {};
const auto no_position = [](PhaseInputs& i) {
  i.position_known = false;
  i.setpoint_valid = i.hold_over = true;
};
const auto no_estimate = [](PhaseInputs& i) { i.estimate_usable = false; };
const auto rests = [](PhaseInputs& i) { i.rests_with_pilot = i.setpoint_valid = i.hold_over = true; };

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
            armed([](PhaseInputs& i) { i.take_off_wanted = true; }), kLanding},
        Row{"NoTakeOffWithoutAPosition", kDisarmed, armed([](PhaseInputs& i) {
              i.take_off_wanted = true;
              i.position_known = false;
            }),
            kDisarmed},
        Row{"ClimbEndsWithoutAPosition", kTakeOff, armed(no_position), kLevelDescent, kPositionUnknown},
        Row{"HoldEndsWithoutAPosition", kHold, armed(no_position), kLevelDescent, kPositionUnknown},
        Row{"OffboardEndsWithoutAPosition", kOffboard, armed(no_position), kLevelDescent, kPositionUnknown},
        Row{"LandingGoesOnLevelWithoutAPosition", kLanding, armed(no_position), kLevelDescent,
            kPositionUnknown},
        Row{"SinksLevel", kLevelDescent, armed(no_position), kLevelDescent},
        Row{"LandsWhenThePositionIsBack", kLevelDescent,
            armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = true; }), kLanding, kPositionKnown},
        Row{"HoldsByRequestWhenThePositionIsBack", kLevelDescent,
            armed([](PhaseInputs& i) { i.resume_wanted = true; }), kHold, kPositionKnown},
        Row{"ClimbFallsSilent", kTakeOff, armed(no_estimate), kSilent, kEstimateLost},
        Row{"HoldFallsSilent", kHold, armed(no_estimate), kSilent, kEstimateLost},
        Row{"OffboardFallsSilent", kOffboard, armed(no_estimate), kSilent, kEstimateLost},
        Row{"LandingFallsSilent", kLanding, armed(no_estimate), kSilent, kEstimateLost},
        Row{"LevelDescentFallsSilent", kLevelDescent, armed(no_estimate), kSilent, kEstimateLost},
        Row{"OnTheGroundItNeedsNoEstimate", kLanding, armed([](PhaseInputs& i) {
              i.estimate_usable = false;
              i.on_ground = true;
            }),
            kLanding},
        Row{"StaysSilent", kSilent,
            armed([](PhaseInputs& i) { i.setpoint_valid = i.hold_over = i.take_off_wanted = true; }),
            kSilent},
        Row{"LandsAfterAShortSilence", kSilent, armed([](PhaseInputs& i) { i.silence_short = true; }),
            kLanding, kEstimateBack},
        Row{"SinksLevelAfterAShortSilence", kSilent, armed([](PhaseInputs& i) {
              i.silence_short = true;
              i.position_known = false;
            }),
            kLevelDescent, kEstimateBack},
        Row{"LandsAfterALongSilenceByRequest", kSilent,
            armed([](PhaseInputs& i) { i.landing_wanted = true; }), kLanding, kEstimateBack},
        Row{"HoldsAfterALongSilenceByRequest", kSilent, armed([](PhaseInputs& i) { i.resume_wanted = true; }),
            kHold},
        Row{"EndsALandingByRequest", kLanding, armed([](PhaseInputs& i) { i.resume_wanted = true; }), kHold},
        Row{"ClimbEndsAtRest", kTakeOff, armed(rests), kDisarmed, kRestsWithPilot},
        Row{"HoldEndsAtRest", kHold, armed(rests), kDisarmed, kRestsWithPilot},
        Row{"OffboardEndsAtRest", kOffboard, armed(rests), kDisarmed, kRestsWithPilot},
        Row{"LandingEndsAtRest", kLanding, armed(rests), kDisarmed, kRestsWithPilot},
        Row{"LevelDescentEndsAtRest", kLevelDescent, armed(rests), kDisarmed, kRestsWithPilot},
        Row{"SilenceEndsAtRest", kSilent, armed(rests), kDisarmed, kRestsWithPilot}),
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
