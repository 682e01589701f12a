#include <gtest/gtest.h>

#include "autopilot/controller/test/vertical_flight.hpp"

namespace ironbird::autopilot {
namespace {

using enum FlightPhase;

/// From the ground into the air, to that phase.
void bring(VerticalFlight& flight, FlightPhase phase) {
  EXPECT_TRUE(flight.ask(FlightWish::kTakeOff));
  flight.live(2.0);
  if (phase != kTakeOff) flight.live(6.0);
  if (phase == kLanding) {
    EXPECT_TRUE(flight.ask(FlightWish::kLand));
    flight.live(1.0);
  }
  if (phase == kLevelDescent) {
    flight.estimate.position_known = false;
    flight.live(1.0);
  }
  EXPECT_EQ(flight.controller.phase(), phase);
  EXPECT_GT(flight.height, 0.5);
}

class HandBackTest : public ::testing::TestWithParam<FlightPhase> {};

TEST_P(HandBackTest, LeavesAVehicleThatThePilotDroppedWhereItLiesWheneverHeHandsBack) {
  int drops = 0;
  for (double held = 0.05; held < 3.0; held += 0.05) {
    VerticalFlight flight;
    bring(flight, GetParam());
    flight.live(held, 0.0);
    if (!flight.on_ground()) continue;
    ++drops;
    for (int i = 0; i < 2000; ++i) {
      flight.live(VerticalFlight::kStep);
      ASSERT_LT(flight.lift, 0.1) << "handed back after " << held << " s";
    }
    EXPECT_EQ(flight.controller.phase(), kDisarmed) << held;
    EXPECT_EQ(flight.controller.cause(), PhaseCause::kRestsWithPilot) << held;
    flight.estimate.position_known = true;
    EXPECT_TRUE(flight.ask(FlightWish::kTakeOff)) << "a request is what it needs";
  }
  EXPECT_GT(drops, 30);
}

TEST_P(HandBackTest, LeavesAVehicleWhereItLiesThatAThrottleStickDroppedAndGoesUpAgain) {
  for (double held = 0.05; held < 3.0; held += 0.05) {
    VerticalFlight flight;
    bring(flight, GetParam());
    flight.live(held, 0.0, 0x020);
    if (!flight.on_ground()) continue;
    for (int i = 0; i < 2000; ++i) {
      flight.live(VerticalFlight::kStep);
      ASSERT_LT(flight.lift, 0.1) << "stick up after " << held << " s";
    }
    EXPECT_EQ(flight.controller.phase(), kDisarmed) << held;
  }
}

TEST(RestWatchTest, BelievesNoOutputsThatTheFcuSaidLongAgo) {
  RestWatch watch;
  StateEstimate estimate;
  estimate.v_NB_B.z() = 0.5;  // not still
  FcuStatus status;
  status.greatest_output = 0.05;
  const auto rests_after_a_while = [&] {
    for (int i = 0; i < 100; ++i) {
      estimate.stamp += std::chrono::milliseconds(10);
      watch.look(estimate, true, status, true, {});
    }
    return watch.rests(estimate.stamp, true, {});
  };
  status.stamp = std::chrono::milliseconds(600);
  EXPECT_FALSE(rests_after_a_while());
  status.output_stamp = std::chrono::milliseconds(590);
  EXPECT_TRUE(rests_after_a_while());
}

TEST_P(HandBackTest, FliesAtOnceWhenHandedBackInTheAir) {
  VerticalFlight flight;
  bring(flight, GetParam());
  flight.live(0.5, 0.97);
  ASSERT_FALSE(flight.on_ground());
  const double height = flight.height;
  flight.live(0.01);
  EXPECT_GT(flight.lift, 0.5);
  flight.live(1.0);
  EXPECT_GT(flight.height, height - 0.8);
}

TEST_P(HandBackTest, CatchesAVehicleThatFallsWhenItIsHandedBack) {
  VerticalFlight flight;
  bring(flight, GetParam());
  flight.live(4.0, 1.3);
  flight.live(3.0, 0.0);
  ASSERT_GT(flight.height, 10.0);
  flight.live(0.01);
  EXPECT_GT(flight.lift, 1.0);
}

TEST_P(HandBackTest, StaysDownAfterAFailsafeThatStruckTheGroundHoweverSoonItEnds) {
  for (double held = 0.02; held < 2.0; held += 0.1) {
    VerticalFlight flight;
    bring(flight, GetParam());
    flight.live(3.0, 1.3);
    while (!flight.on_ground()) flight.live(VerticalFlight::kStep, 0.6);  // not idle
    flight.live(held, 0.6);
    for (int i = 0; i < 4000; ++i) {
      flight.live(VerticalFlight::kStep);
      ASSERT_LT(flight.lift, 0.1) << "handed back " << held << " s after the blow";
    }
    EXPECT_EQ(flight.controller.phase(), kDisarmed) << held;
  }
}

TEST_P(HandBackTest, DoesNotClimbWhenItIsHandedBackTooLateForACatch) {
  for (double late = 0.02; late < 0.4; late += 0.02) {
    VerticalFlight flight;
    bring(flight, GetParam());
    flight.live(3.0, 1.3);
    while (flight.height > flight.v_down * late) flight.live(VerticalFlight::kStep, 0.0);
    while (!flight.on_ground()) flight.live(VerticalFlight::kStep);
    for (int i = 0; i < 2000; ++i) {
      flight.live(VerticalFlight::kStep);
      ASSERT_LT(flight.height, 0.05) << "handed back " << late << " s before the blow";
    }
  }
}

TEST_P(HandBackTest, FliesOnAfterABlowFromWhichItFlewAway) {
  VerticalFlight flight;
  bring(flight, GetParam());
  flight.live(3.0, 1.3);
  while (!flight.on_ground()) flight.live(VerticalFlight::kStep, 0.6);
  flight.live(2.0, 1.5);
  ASSERT_GT(flight.height, 3.0);
  flight.live(0.01);
  EXPECT_GT(flight.lift, 0.2) << "it stops a climb";
}

TEST(RestWatchTest, DoesNotTakeTheTopOfABounceForRest) {
  for (const double fall : {0.7, 1.0, 3.0}) {  // m/s^2: the motors lift the rest of the weight
    RestWatch watch;
    StateEstimate estimate;
    FcuStatus status;
    status.greatest_output = 0.6;
    for (double v_down = -1.0; v_down < 1.0; v_down += 0.0025 * fall) {
      estimate.stamp += std::chrono::microseconds(2500);
      status.stamp = status.output_stamp = estimate.stamp;
      estimate.v_NB_B.z() = v_down;
      watch.look(estimate, true, status, true, {});
      ASSERT_FALSE(watch.rests(estimate.stamp, true, {})) << fall << " m/s^2, at " << v_down << " m/s";
    }
  }
}

TEST_P(HandBackTest, CatchesAVehicleThatTheAirCarriesWheneverItIsHandedBack) {
  for (double held = 1.5; held < 8.0; held += 0.25) {
    VerticalFlight flight;
    flight.terminal_speed = 12.0;
    bring(flight, GetParam());
    flight.live(12.0, 1.5);
    flight.live(held, 0.0);
    ASSERT_GT(flight.height, 10.0);
    flight.live(0.01);
    ASSERT_GT(flight.lift, 1.0) << "after " << held << " s, at " << flight.v_down << " m/s";
  }
}

TEST_P(HandBackTest, CatchesAVehicleThatSinksFastWithMotorsThatHaveOnlyJustBegunToIdle) {
  VerticalFlight flight;
  flight.terminal_speed = 12.0;
  bring(flight, GetParam());
  flight.live(8.0, 1.5);
  flight.live(4.0, 0.15);  // a fall, and yet not idle
  flight.live(0.3, 0.05);
  ASSERT_GT(flight.height, 10.0);
  flight.live(0.01);
  EXPECT_GT(flight.lift, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Phases, HandBackTest, ::testing::Values(kTakeOff, kHold, kLanding, kLevelDescent),
                         [](const auto& phase) {
                           for (const auto& [value, name] : enumerators(FlightPhase{})) {
                             if (value == phase.param) return std::string(name);
                           }
                           return std::string("unknown");
                         });

TEST(LandingTest, NeverClimbsFromAnyStateAndStopsAClimbThatItFinds) {
  for (const double v_down : {-3.0, -1.0, -0.1, 0.0, 0.3, 1.0, 2.0, 4.0, 8.0}) {
    for (const bool by_pilot : {false, true}) {
      VerticalFlight flight;
      bring(flight, kLanding);
      flight.height = 40.0;
      flight.estimate.p_NB_N.z() = -40.0;
      if (by_pilot) flight.live(0.5, 1.0);
      flight.v_down = flight.estimate.v_NB_B.z() = v_down;
      double least = std::min(v_down, 0.0);
      while (!flight.on_ground() && flight.estimate.stamp < std::chrono::seconds(300)) {
        const double before = flight.height;
        flight.live(VerticalFlight::kStep);
        if (v_down >= 0.0) {
          ASSERT_LE(flight.height, before + 1e-9) << v_down << " m/s";
        }
        ASSERT_GE(flight.v_down, least - 1e-9) << v_down << " m/s: it climbs faster";
        least = std::min(flight.v_down, 0.0);
      }
      EXPECT_TRUE(flight.on_ground()) << v_down << " m/s";
    }
  }
}

}  // namespace
}  // namespace ironbird::autopilot
