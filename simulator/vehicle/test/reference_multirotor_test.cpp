// Our vehicle against the table that follows from the reference simulator's formulas (rosflight_sim at
// 68729f2b), still air of 1.225 kg/m^3.

#include <gtest/gtest.h>

#include <numbers>

#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {
namespace {

EnvironmentParams reference_environment() {
  EnvironmentParams params;
  params.gravity = 9.81;
  params.air.constant_density = true;
  params.air.density = 1.225;
  return params;
}

VehicleParams without_ground_effect() {
  VehicleParams params = reference_multirotor();
  params.ground_effect.kind = GroundEffectKind::kNone;
  return params;
}

RotorCommands all(double command) {
  RotorCommands commands;
  commands.throttle.fill(command);
  return commands;
}

struct ThrottleCase {
  const char* name;
  double command;
  double speed;    // rad/s
  double thrust;   // N, of one rotor
  double torque;   // N*m, of one rotor
  double total;    // N
  double current;  // A, through one motor
};

class ThrottleTest : public ::testing::TestWithParam<ThrottleCase> {};

TEST_P(ThrottleTest, TurnsAndPullsAsTheReference) {
  const ThrottleCase& row = GetParam();
  const Environment environment(reference_environment(), 1);
  Vehicle vehicle(without_ground_effect(), environment);
  vehicle.set_commands(all(row.command));
  const RigidBodyState still;
  const Forces forces = vehicle.evaluate(still, RotorSpeeds::Zero(), 0.0);
  RotorSpeeds speeds = RotorSpeeds::Zero();
  vehicle.settle(still, speeds);

  // Half of the last digit that the table gives.
  EXPECT_NEAR(speeds[0], row.speed, 0.05);
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z() / 4.0, row.thrust, 0.0005);
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z(), row.total, 0.005);
  const Rotor rotor(reference_multirotor().rotor);
  EXPECT_NEAR(rotor.torque(speeds[0], 0.0, 1.225), row.torque, 0.00005);
  EXPECT_NEAR(rotor.current(24.0 * row.command, speeds[0]), row.current, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Commands, ThrottleTest,
                         ::testing::Values(ThrottleCase{"c10", 0.1, 80.4, 0.369, 0.0069, 1.48, 1.7},
                                           ThrottleCase{"c20", 0.2, 162.3, 1.503, 0.0281, 6.01, 2.5},
                                           ThrottleCase{"c30", 0.3, 243.5, 3.383, 0.0633, 13.53, 3.7},
                                           ThrottleCase{"c40", 0.4, 324.0, 5.990, 0.1121, 23.96, 5.4},
                                           ThrottleCase{"c50", 0.5, 403.8, 9.306, 0.1741, 37.22, 7.5},
                                           ThrottleCase{"c60", 0.6, 483.0, 13.313, 0.2490, 53.25, 10.1},
                                           ThrottleCase{"c70", 0.7, 561.5, 17.995, 0.3366, 71.98, 13.1},
                                           ThrottleCase{"c80", 0.8, 639.4, 23.337, 0.4366, 93.35, 16.6},
                                           ThrottleCase{"c90", 0.9, 716.8, 29.322, 0.5485, 117.29, 20.5},
                                           ThrottleCase{"c100", 1.0, 793.5, 35.936, 0.6723, 143.74, 24.7}),
                         [](const auto& case_) { return case_.param.name; });

struct ClimbCase {
  const char* name;
  double climb;   // m/s
  double thrust;  // N, of one rotor at half command
};

class ClimbTest : public ::testing::TestWithParam<ClimbCase> {};

TEST_P(ClimbTest, LosesThrustAsTheReference) {
  const Environment environment(reference_environment(), 1);
  VehicleParams params = without_ground_effect();
  params.drag = {};
  Vehicle vehicle(params, environment);
  vehicle.set_commands(all(0.5));
  RigidBodyState climbing;
  climbing.v_NB_N.z() = -GetParam().climb;
  const Forces forces = vehicle.evaluate(climbing, RotorSpeeds::Zero(), 0.0);
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z() / 4.0, GetParam().thrust, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Speeds, ClimbTest,
                         ::testing::Values(ClimbCase{"Still", 0.0, 9.31}, ClimbCase{"Sinking", -5.0, 9.31},
                                           ClimbCase{"v2", 2.0, 8.25}, ClimbCase{"v5", 5.0, 6.36},
                                           ClimbCase{"v10", 10.0, 2.34}, ClimbCase{"v15", 15.0, 0.01}),
                         [](const auto& case_) { return case_.param.name; });

TEST(ReferenceMultirotorTest, HoversAsTheReference) {
  const Environment environment(reference_environment(), 1);
  Vehicle vehicle(without_ground_effect(), environment);
  EXPECT_NEAR(vehicle.equilibrium_command(), 0.4799, 0.00005);
  EXPECT_NEAR(vehicle.equilibrium_speeds()[0], 387.8, 0.05);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  const Forces forces = vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0);
  constexpr double kRounding = 1e-10;
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z(), 3.5 * 9.81, kRounding);
  EXPECT_NEAR(forces.wrench.M_Bcm_B.norm(), 0.0, kRounding);
}

TEST(ReferenceMultirotorTest, HasTheReferencesThrustToWeightRatio) {
  const Environment environment(reference_environment(), 1);
  Vehicle vehicle(without_ground_effect(), environment);
  vehicle.set_commands(all(1.0));
  const Forces forces = vehicle.evaluate(RigidBodyState{}, RotorSpeeds::Zero(), 0.0);
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z() / (3.5 * 9.81), 4.19, 0.005);
}

struct GroundCase {
  const char* name;
  double height;  // m
  double force;   // N
};

class GroundEffectTest : public ::testing::TestWithParam<GroundCase> {};

TEST_P(GroundEffectTest, LiftsAsTheReferenceEvenWithMotorsOff) {
  const Environment environment(reference_environment(), 1);
  Vehicle vehicle(reference_multirotor(), environment);
  vehicle.set_commands(all(0.0));
  RigidBodyState state;
  state.p_NB_N.z() = -GetParam().height;
  const Forces forces = vehicle.evaluate(state, RotorSpeeds::Zero(), 0.0);
  EXPECT_NEAR(-forces.wrench.F_Bcm_B.z(), GetParam().force, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Heights, GroundEffectTest,
                         ::testing::Values(GroundCase{"OnTheGround", 0.0, 0.0},
                                           GroundCase{"Begin", 0.122, 0.0}, GroundCase{"Peak", 0.349, 4.20},
                                           GroundCase{"h50", 0.5, 3.3}, GroundCase{"h80", 0.8, 0.5},
                                           GroundCase{"h100", 1.0, 0.2}, GroundCase{"h120", 1.2, 0.46},
                                           GroundCase{"High", 1.4, 0.0}),
                         [](const auto& case_) { return case_.param.name; });

TEST(ReferenceMultirotorTest, DragsAsTheReference) {
  const Environment environment(reference_environment(), 1);
  Vehicle vehicle(without_ground_effect(), environment);
  vehicle.set_commands(all(vehicle.equilibrium_command()));
  RigidBodyState state;
  state.v_NB_N = {3.0, -4.0, 0.0};
  const Vector3 F_B = vehicle.evaluate(state, RotorSpeeds::Zero(), 0.0).wrench.F_Bcm_B;
  const double body = 0.5 * 1.225 * 2.05 * 0.04 * 5.0;
  const double induced = 0.05 * 3.5 * 9.81;
  constexpr double kRounding = 1e-9;
  EXPECT_NEAR(F_B.x(), -(body + induced) * 3.0, kRounding);
  EXPECT_NEAR(F_B.y(), (body + induced) * 4.0, kRounding);
}

}  // namespace
}  // namespace ironbird::simulator
