#pragma once

#include "hil_bridge/executive/guard.hpp"

namespace ironbird::hil_bridge::test {

inline constexpr Time kPeriod = std::chrono::microseconds(2500);

/// A unit about which everything is as the test says.
class ToldWatch final : public UnitWatch {
 public:
  void take(const Arrival&) override {}
  void report(Time, InterlockInputs& in) override { in = told; }

  InterlockInputs told = {.link_alive = true,
                          .unit_known = true,
                          .unit_disarmed = true,
                          .unit_faultless = true,
                          .parameters_equal = true,
                          .sensors_flow = true,
                          .radio_present = true};
};

inline InterlockConfig wide_config(InterlockProfile profile = InterlockProfile::kFlight) {
  return {
      .profile = profile,
      .limits = {
          .thrust = 1e9, .torque = 1e9, .angle = 1e9, .rate = 1e9, .greatest_age = std::chrono::hours(1)}};
}

inline autopilot::StateEstimate good_estimate() {
  autopilot::StateEstimate estimate;
  estimate.health = autopilot::Health::kGood;
  return estimate;
}

/// A guard that the pilot has made live.
class LiveGuard {
 public:
  explicit LiveGuard(const InterlockConfig& config = wide_config()) : guard(config, watch) {
    guard.want({.release = true});
    for (int k = 0; k < 3; ++k) guard.step(good_estimate(), true, Time{});
    guard.want({});
    watch.told.unit_disarmed = false;
    watch.told.unit_armed = true;
    guard.step(good_estimate(), true, Time{});
  }

  ToldWatch watch;
  Guard guard;
};

}  // namespace ironbird::hil_bridge::test
