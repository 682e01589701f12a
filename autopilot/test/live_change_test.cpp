#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "autopilot/controller/cascaded_controller.hpp"
#include "autopilot/test/autopilot_flight.hpp"

namespace ironbird::autopilot {
namespace {

using ::testing::HasSubstr;

using LiveChangesTest = AutopilotFlight;

TEST_F(LiveChangesTest, RefusesInFlightWhatCouldBringItDownAndNothingOnTheGround) {
  struct Change {
    const char* path;
    double value;
  };
  const std::vector<Change> deadly{{"controller.mass", 0.39},
                                   {"controller.gravity", 1.0},
                                   {"controller.max_thrust", 20.0},
                                   {"controller.min_thrust", 60.0},
                                   {"controller.max_roll_torque", 0.0},
                                   {"controller.max_pitch_torque", 0.01},
                                   {"controller.max_yaw_torque", 0.0},
                                   {"controller.min_altitude_for_attitude_control", 10.0},
                                   {"controller.max_throttle", 0.3},
                                   {"controller.equilibrium_throttle", 1.0},
                                   {"controller.max_climb_acceleration", 0.1},
                                   {"controller.roll_to_torque.kp", 0.0},
                                   {"controller.pitch_to_torque.kd", 0.0},
                                   {"controller.roll_to_torque.ki", 50.0},
                                   {"controller.vel_d_to_accel.ki", 50.0},
                                   {"controller.pos_n_to_vel.kp", 50.0},
                                   {"controller.yaw_rate_to_torque.kp", 0.0},
                                   {"controller.derivative_time_constant", 1.0},
                                   {"controller.max_pitch", 1.5},
                                   {"controller.max_descent_speed", 0.45},
                                   {"controller.max_climb_speed", 0.1},
                                   {"controller.touch_down_time", 0.5},
                                   {"controller.touch_down_speed", 0.3},
                                   {"controller.touch_down_lift", 1.0},
                                   {"controller.rest_speed", 1.0},
                                   {"controller.rest_time", 0.1},
                                   {"controller.idle_output", 0.9},
                                   {"trajectory_follower.down.ki", 50.0},
                                   {"trajectory_follower.mass", 0.39},
                                   {"trajectory_follower.gravity", 30.0},
                                   {"trajectory_follower.max_thrust", 20.0},
                                   {"trajectory_follower.min_lift", 30.0},
                                   {"trajectory_follower.down.kd", 0.0}};
  for (const Change& change : deadly) {
    const ParameterValue before = *autopilot_.parameters().get(change.path);
    EXPECT_TRUE(autopilot_.request(SetParameter{change.path, change.value}).accepted) << change.path;
    ask(SetParameter{change.path, before});
  }
  take_off();
  for (const Change& change : deadly) {
    const ParameterValue before = *autopilot_.parameters().get(change.path);
    const RequestOutcome outcome = autopilot_.request(SetParameter{change.path, change.value});
    EXPECT_THAT(outcome.reason, HasSubstr("not in flight")) << change.path;
    EXPECT_EQ(autopilot_.parameters().get(change.path), before) << change.path;
  }
}

TEST_F(LiveChangesTest, MeasuresAChangeInFlightByWhatWasConfiguredNotByTheChangeBefore) {
  take_off();
  ask(SetParameter{"controller.mass", 3.3});
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.mass", 2.8}).accepted);
  ask(SetParameter{"controller.mass", 4.5});
}

TEST_F(LiveChangesTest, RefusesAnotherKindOfOutputInFlight) {
  ask(SetParameter{"controller.take_off_pass_through", false});
  ask(SetParameter{"controller.take_off_pass_through", true});
  take_off();
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.take_off_pass_through", false}).accepted);
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.acceleration_output", 0}).accepted);
}

TEST_F(LiveChangesTest, MeasuresAChangeByWhatWasConfiguredHoweverOftenTheModuleIsSwapped) {
  const SwapModule same{"controller", "cascaded_controller", {}};
  take_off();
  ask(SetParameter{"controller.mass", 3.2});
  ask(same);
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.mass", 2.6}).accepted);
  ask(SetParameter{"controller.mass", 4.5});
  // NOR does a swap bring what a setting may not
  const RequestOutcome outcome = autopilot_.request(
      SwapModule{"trajectory_follower", "flat_pid_follower", {{"trajectory_follower.mass", 2.0}}});
  EXPECT_THAT(outcome.reason, HasSubstr("not in flight"));
  EXPECT_EQ(autopilot_.parameters().get("trajectory_follower.mass"), ParameterValue(3.9));
}

class KindOfAnotherNameTest : public AutopilotFlight {
 protected:
  KindOfAnotherNameTest() : AutopilotFlight(with_another_name()) {}

  static Modules with_another_name() {
    Modules modules = standard_modules();
    modules.controllers.add<CascadedController>("another");
    return modules;
  }
};

TEST_F(KindOfAnotherNameTest, MeasuresChangesInFlightByWhatItIsConfiguredTo) {
  take_off();
  ask(SetParameter{"controller.mass", 3.2});
  ask(SwapModule{"controller", "another", {}});
  EXPECT_EQ(autopilot_.parameters().get("controller.mass"), ParameterValue(3.2)) << "it was asked for";
  EXPECT_FALSE(autopilot_.request(SetParameter{"controller.mass", 2.6}).accepted);
  ask(SetParameter{"controller.mass", 4.5});
  // NOR does a swap keep a change that its own configuration does not allow
  const RequestOutcome outcome =
      autopilot_.request(SwapModule{"controller", "cascaded_controller", {{"controller.mass", 3.4}}});
  EXPECT_THAT(outcome.reason, HasSubstr("controller.mass"));
  EXPECT_EQ(autopilot_.parameters().get("controller.mass"), ParameterValue(4.5));
}

TEST_F(KindOfAnotherNameTest, IsConfiguredToWhatWasAskedForOnTheGround) {
  ask(SetParameter{"controller.mass", 3.2});
  take_off();
  ask(SwapModule{"controller", "another", {}});
  ask(SetParameter{"controller.mass", 2.6});
}

/// What may be set in flight, as far as it may: upper and lower ends.
class LiveChangeTest : public AutopilotFlight, public ::testing::WithParamInterface<SetParameter> {};

TEST_P(LiveChangeTest, LeavesTheVehicleFlyingUpright) {
  ask(RouteRequest{SetRoute{{place(4, 0, -5)}, false}});
  take_off();
  ASSERT_TRUE(until(20.0, [](const Signals& s) { return s.trajectory.finished; }));
  ask(GetParam());
  double lowest = 1.0;
  until(10.0, [&](const Signals& s) {
    lowest = std::min(lowest, (s.estimate.q_NB * Vector3::UnitZ()).z());
    return false;
  });
  EXPECT_GT(lowest, 0.9);
  EXPECT_LT((vehicle_.p_NB_N - Vector3(4, 0, -5)).norm(), 0.6);
}

INSTANTIATE_TEST_SUITE_P(Ends, LiveChangeTest,
                         ::testing::Values(SetParameter{"controller.mass", 3.9 / 1.24},
                                           SetParameter{"controller.mass", 3.9 * 1.24},
                                           SetParameter{"controller.gravity", 12.0},
                                           SetParameter{"controller.max_thrust", 50.0},
                                           SetParameter{"controller.min_thrust", 19.0},
                                           SetParameter{"controller.max_roll_torque", 1.7},
                                           SetParameter{"controller.roll_to_torque.kp", 1.3},
                                           SetParameter{"controller.pitch_to_torque.kp", 11.6},
                                           SetParameter{"trajectory_follower.mass", 3.9 / 1.24},
                                           SetParameter{"trajectory_follower.mass", 3.9 * 1.24},
                                           SetParameter{"trajectory_follower.max_thrust", 50.0},
                                           SetParameter{"trajectory_follower.down.kp", 4.1}),
                         [](const auto& case_) {
                           std::string name = case_.param.path + std::to_string(case_.index);
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace ironbird::autopilot
