#pragma once

#include <gtest/gtest.h>

#include "autopilot/autopilot.hpp"
#include "autopilot/test/little_vehicle.hpp"

namespace ironbird::autopilot {

inline AutopilotConfig on_external_pose() {
  AutopilotConfig config;
  config.estimator.kind = "external_pose";
  return config;
}

inline Waypoint place(double north, double east, double down, WaypointKind kind = WaypointKind::kGoto) {
  Waypoint waypoint;
  waypoint.p_N << north, east, down;
  waypoint.kind = kind;
  return waypoint;
}

/// An autopilot around the little vehicle.
class AutopilotFlight : public ::testing::Test {
 protected:
  explicit AutopilotFlight(const Modules& modules = standard_modules(),
                           const AutopilotConfig& config = on_external_pose())
      : autopilot_{config, modules} {}

  const Signals& step() {
    vehicle_.fly(autopilot_.step(vehicle_.frame()));
    return autopilot_.signals();
  }

  template <class Done>
  bool until(double seconds, Done&& done) {
    for (int i = 0; i < seconds / 0.0025; ++i) {
      if (done(step())) return true;
    }
    return false;
  }

  void fly(double seconds) {
    until(seconds, [](const Signals&) { return false; });
  }

  void ask(const Request& request) {
    const RequestOutcome outcome = autopilot_.request(request);
    ASSERT_TRUE(outcome.accepted) << outcome.reason;
  }

  void take_off() {
    vehicle_.status.armed = true;
    step();
    ask(TakeOff{});
    ASSERT_TRUE(until(10.0, [](const Signals& s) { return s.flight.phase == FlightPhase::kHold; }));
  }

  Autopilot autopilot_;
  LittleVehicle vehicle_;
};

}  // namespace ironbird::autopilot
